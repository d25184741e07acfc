// Solves the trees of joints of an object in a substep.
#include <algorithm>
#include <optional>

#include "math/quat.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/free_tree.h"
#include "solver/bodies/joint_forest_work.h"
#include "solver/bodies/joint_formulas.h"
#include "solver/bodies/rod_bundle.h"
#include "solver/stencil.h"

namespace pliant {

namespace {

/// Sets the forces by which the last solve's multipliers pull, in the order of the joints.
void find_pulls(const JointForest& forest, std::vector<JointForest::Pull>& pulls) {
  pulls.assign(forest.joints.size(), {});
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    if (!forest.joints[j].in_tree) continue;
    const JointRows& rows = forest.rows[j];
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows.rows); ++row) {
      pulls[j][0] = pulls[j][0] - rows.of_a[row][0] * forest.multipliers[j][row];
      pulls[j][1] = pulls[j][1] - rows.of_b[row][0] * forest.multipliers[j][row];
    }
  }
}

/// Computes the geometric stiffness of all bodies from the pulls of joints. Returns the largest ratio of |f||r| to the
/// mean inertia of a body. The rest data of joints begin with the anchor in a, then in b.
float find_stiffness(JointWork& work, const std::vector<JointForest::Pull>& pulls) {
  JointForest& forest = work.forest;
  forest.stiffness.assign(forest.bodies.size(), {});
  forest.sizes.assign(forest.bodies.size(), 0);
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    const JointForest::Joint& joint = forest.joints[j];
    if (!joint.in_tree) continue;
    const ConstraintPlace at = place_of(work, joint.parts.front());
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? forest.ends[j].a : forest.ends[j].b;
      if (body < 0) continue;
      const Vec3f anchor{at.value(3 * side), at.value(3 * side + 1), at.value(3 * side + 2)};
      const std::int32_t frame = joint.slots[2 * static_cast<std::size_t>(side) + 1];
      const auto b = static_cast<std::size_t>(body);
      const Vec3f arm = rotate(quaternion(work.frames.orientations[frame]), anchor);
      forest.sizes[b] = forest.sizes[b] + joint_formulas::add_stiffness(pulls[j][static_cast<std::size_t>(side)], arm,
                                                                        forest.stiffness[b].data());
    }
  }
  float largest = 0;
  for (std::size_t i = 0; i < forest.sizes.size(); ++i) {
    const Symmetric& inertia = forest.masses[i].inertia;
    largest = max(largest, forest.sizes[i] * 3 / (inertia[0] + inertia[1] + inertia[2]));
  }
  return largest;
}

/// Adds the stiffness to the inertia, and takes away the part of the predicted rotation that it prevents.
void stiffen(JointWork& work) {
  JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const std::int32_t frame = forest.bodies[i].frame;
    BodyMass& mass = forest.masses[i];
    for (std::size_t k = 0; k < 6; ++k) mass.inertia[k] = mass.inertia[k] + forest.stiffness[i][k];
    mass.inverse = inverse_of(mass.inertia);
    if (!work.points.first_pass) continue;
    const Vec3f predicted = xyz(work.frames.predicted[frame]);
    rotate_frame(-times(mass.inverse, times(forest.stiffness[i], predicted)), work.frames.orientations[frame],
                 work.frames.corrections[frame]);
  }
}

void store_multipliers(JointWork& work) {
  const JointForest& forest = work.forest;
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    if (!forest.joints[j].in_tree) continue;
    std::size_t row = 0;
    for (const JointForest::Part& part : forest.joints[j].parts) {
      const ConstraintPlace at = place_of(work, part);
      float* multipliers = multipliers_of(work, at);
      for (int r = 0; r < at.pool.components; ++r, ++row) {
        if (multipliers == nullptr) continue;
        float& multiplier = multipliers[r * batch_width];  // of the opposite sign in the tree
        multiplier = (work.points.first_pass ? 0.f : multiplier) - forest.multipliers[j][row];
      }
    }
  }
}

void apply(JointWork& work) {
  const JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const std::int32_t point = forest.bodies[i].point, frame = forest.bodies[i].frame;
    Record& d = work.points.displacements[point];
    const Vec3f& move = forest.corrections[i].displacement;
    if (work.points.positions[point].w > 0) d = {d.x + move.x, d.y + move.y, d.z + move.z, 0};
    rotate_frame(forest.corrections[i].rotation, work.frames.orientations[frame], work.frames.corrections[frame]);
  }
  store_multipliers(work);
}

/// Solves again with the present gradients, and with the stiffness of the pulls that were found last. A free tree is
/// noted before.
void solve_stiffly(JointWork& work, std::optional<FreeTree>& free) {
  if (is_free(work.forest)) free.emplace(work.forest.bodies, work.points, work.frames);
  stiffen(work);
  fill_rows(work, false);
  solve_within_bounds(work.forest);
}

/// Adds the pulls of a pass to those of the substep's passes before it.
void keep_pulls(JointWork& work) {
  JointForest& forest = work.forest;
  find_pulls(forest, forest.pulls_of_pass);
  if (work.points.first_pass) forest.pulls.assign(forest.joints.size(), {});
  for (std::size_t j = 0; j < forest.pulls.size(); ++j)
    for (std::size_t side = 0; side < 2; ++side)
      forest.pulls[j][side] = forest.pulls[j][side] + forest.pulls_of_pass[j][side];
}

/// Solves with the gradients of the substep's start, and again where that finds that the pulls need stiffness.
void solve_softly(JointWork& work, std::optional<FreeTree>& free) {
  JointForest& forest = work.forest;
  fill_rows(work, true);
  solve_within_bounds(forest);
  find_pulls(forest, forest.pulls_of_pass);
  for (std::size_t j = 0; j < forest.pulls.size() && !work.points.first_pass; ++j)
    for (std::size_t side = 0; side < 2; ++side)
      forest.pulls_of_pass[j][side] = forest.pulls[j][side] + forest.pulls_of_pass[j][side];
  if (find_stiffness(work, forest.pulls_of_pass) > largest_advance) solve_stiffly(work, free);
}

/// Where the joints of the last substep pulled hard, they do so now, and one solve is enough. What is kept is of this
/// frame alone, so a restored State gives the same bits.
bool was_pulled_hard(JointWork& work, const Substep& s) {
  JointForest& forest = work.forest;
  if (!work.points.first_pass || s.number == 0 || forest.pulls.size() != forest.joints.size()) return false;
  const float scale = work.points.h * work.points.h * forest.inverse_h2_of_pulls;
  for (JointForest::Pull& pull : forest.pulls) pull = {pull[0] * scale, pull[1] * scale};
  return find_stiffness(work, forest.pulls) > largest_advance;
}

/// Solves the trees of an object.
void solve_object(const Substep& s, JointWork& work) {
  fill_masses(work);
  std::optional<FreeTree> free;
  if (was_pulled_hard(work, s))
    solve_stiffly(work, free);
  else
    solve_softly(work, free);
  keep_pulls(work);
  work.forest.inverse_h2_of_pulls = work.points.inverse_h2;
  apply(work);
  if (free) free->restore();
}

/// Forests that one task solves: of one object, from `first` on.
struct ForestTask {
  int object = 0;
  std::size_t first = 0, count = 0;
};

/// Small forests share a task, up to this many joints.
constexpr std::size_t joints_of_task = 64;

std::vector<ForestTask> tasks_of(const Substep& s, Bundled bundled) {
  std::vector<ForestTask> tasks;
  for_objects(s, [&](int o) {
    const auto& forests = s.work.joints[static_cast<std::size_t>(o)].forests;
    std::size_t joints = joints_of_task;
    for (std::size_t i = 0; i < forests.size(); ++i) {
      if (bundled == Bundled::left_out && forests[i].in_bundle) {
        joints = joints_of_task;
        continue;
      }
      if (joints >= joints_of_task) {
        tasks.push_back({o, i, 0});
        joints = 0;
      }
      ++tasks.back().count;
      joints += forests[i].joints.size();
    }
  });
  return tasks;
}

}  // namespace

void for_trees(Substep& s, bool first_pass, Bundled bundled, FunctionRef<void(JointWork&)> body) {
  const std::vector<ForestTask> tasks = tasks_of(s, bundled);
  if (tasks.empty()) return;
  for_tasks(s, "solve: joints", static_cast<int>(tasks.size()), [&](int number) {
    const ForestTask& task = tasks[static_cast<std::size_t>(number)];
    const int o = task.object;
    for (std::size_t i = task.first; i < task.first + task.count; ++i) {
      JointWork work{s.model.objects[static_cast<std::size_t>(o)], arguments(s, o, first_pass), frame_arguments(s, o),
                     s.work.joints[static_cast<std::size_t>(o)].forests[i], o};
      body(work);
    }
  });
}

void solve_joint_trees(Substep& s, bool first_pass) {
  for_trees(s, first_pass, Bundled::left_out, [&](JointWork& work) { solve_object(s, work); });
  solve_rod_bundles(s, first_pass);
}

void close_joint_trees(Substep& s) {
  for_trees(s, false, Bundled::left_out, [&](JointWork& work) {
    for (int round = 0; round < most_closing_rounds && is_open(work, closed_share); ++round) solve_object(s, work);
  });
  close_rod_bundles(s);
}

}  // namespace pliant
