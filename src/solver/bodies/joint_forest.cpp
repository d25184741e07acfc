#include "solver/bodies/joint_forest.h"

#include <algorithm>
#include <map>

#include "constraints/registry.h"
#include "math/quat.h"
#include "solver/project.h"
#include "solver/stencil.h"
#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

namespace {

Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }
Quatf quaternion(const Record& r) { return {r.x, r.y, r.z, r.w}; }

/// True if a body moves and rotates about all axes, or not at all; others are left to the stencil driver.
enum class Mobility { fixed, free, partial };

Mobility mobility(const CompiledObject& object, std::int32_t point, std::int32_t frame) {
  const Vec3f inverse = xyz(object.frames.inverse_inertias[static_cast<std::size_t>(frame)]);
  const float w = object.positions[static_cast<std::size_t>(point)].w;
  if (w > 0 && inverse.x > 0 && inverse.y > 0 && inverse.z > 0) return Mobility::free;
  return w == 0 && inverse == Vec3f{} ? Mobility::fixed : Mobility::partial;
}

/// Numbers the bodies of a forest while its joints are found.
class BodyNumbers {
 public:
  BodyNumbers(const CompiledObject& object, JointForest& forest) : object_(object), forest_(forest) {}

  /// The number of a body; -1: fixed. Returns false if the body cannot be part of a tree.
  bool find(std::int32_t point, std::int32_t frame, int& number) {
    const Mobility its = mobility(object_, point, frame);
    number = -1;
    if (its != Mobility::free) return its == Mobility::fixed;
    const auto [at, is_new] = numbers_.try_emplace(point, static_cast<int>(forest_.bodies.size()));
    if (is_new) forest_.bodies.push_back({point, frame});
    number = at->second;
    return forest_.bodies[static_cast<std::size_t>(number)].frame == frame;
  }

 private:
  const CompiledObject& object_;
  JointForest& forest_;
  std::map<std::int32_t, int> numbers_;
};

bool is_marked(const std::vector<std::vector<char>>& marks, const ConstraintPlace& at) {
  if (marks.empty()) return false;
  const auto& pool = marks[static_cast<std::size_t>(at.pool_number)];
  return !pool.empty() && pool[static_cast<std::size_t>(at.batch * batch_width + at.lane)] != 0;
}

void find_joints(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, JointForest& forest) {
  BodyNumbers numbers(object, forest);
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    if (!constraint_type(pool.type).is_joint || pool.law == Law::pbd) continue;
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      if (is_marked(is_broken, at)) return;
      JointForest::Joint joint{at.pool_number, at.batch, at.lane, {}};
      for (std::size_t slot = 0; slot < 4; ++slot)
        joint.slots[slot] = number[slot] - (slot % 2 == 1 ? object.particles : 0);
      JointEnds ends;
      const bool a = numbers.find(joint.slots[0], joint.slots[1], ends.a);
      const bool b = numbers.find(joint.slots[2], joint.slots[3], ends.b);
      if (!a || !b) return;
      forest.joints.push_back(joint);
      forest.ends.push_back(ends);
    });
  }
}

/// Marks the constraints that the stencil driver leaves out.
void mark_skipped(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, JointForest& forest) {
  const auto lanes = [](const Pool& pool) { return static_cast<std::size_t>(pool.batches) * batch_width; };
  forest.is_skipped = is_broken;
  forest.is_skipped.resize(object.pools.size());
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    if (forest.in_tree[j] == 0) continue;
    const JointForest::Joint& joint = forest.joints[j];
    auto& marks = forest.is_skipped[static_cast<std::size_t>(joint.pool)];
    marks.resize(lanes(object.pools[static_cast<std::size_t>(joint.pool)]));
    marks[static_cast<std::size_t>(joint.batch * batch_width + joint.lane)] = 1;
  }
  forest.skipped.clear();
  for (const auto& marks : forest.is_skipped) forest.skipped.push_back(marks.empty() ? nullptr : marks.data());
  if (std::all_of(forest.skipped.begin(), forest.skipped.end(), [](const char* p) { return p == nullptr; }))
    forest.skipped.clear();
}

// ---------------------------------------------------------------- one substep

/// The arrays of an object, and one constraint at a time.
struct Work {
  const CompiledObject& object;
  SweepArguments points;
  FrameArguments frames;
  JointForest& forest;
  StencilArrays<float> arrays{};
};

/// Sets the slots of a joint to the positions at the substep's start, or now. Points are relative to the first.
void load(Work& work, const JointForest::Joint& joint, bool at_start) {
  const std::int32_t origin = joint.slots[0];
  const auto moved = [&](std::int32_t n) {
    return at_start ? xyz(work.points.remainders[n]) : xyz(work.points.displacements[n]);
  };
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    if (slot % 2 == 1) {
      const Record& q = at_start ? work.frames.starts[n] : work.frames.orientations[n];
      work.arrays.set_slot(slot, q.x, q.y, q.z, q.w);
      continue;
    }
    const Vec3f x = (xyz(work.points.positions[n]) - xyz(work.points.positions[origin])) + (moved(n) - moved(origin));
    work.arrays.set_slot(slot, x.x, x.y, x.z, 0);
  }
}

void evaluate(Work& work, const JointForest::Joint& joint, bool at_start) {
  const Pool& pool = work.object.pools[static_cast<std::size_t>(joint.pool)];
  load(work, joint, at_start);
  constraint_type(pool.type).evaluate(work.arrays.slots, work.arrays.rest, work.arrays.c, work.arrays.gradients);
}

float* multipliers_of(const Work& work, const JointForest::Joint& joint) {
  if (work.points.multipliers == nullptr) return nullptr;
  float* all = work.points.multipliers[joint.pool];
  const Pool& pool = work.object.pools[static_cast<std::size_t>(joint.pool)];
  return all == nullptr ? nullptr : all + multiplier_index(pool, joint.batch, joint.lane, 0);
}

/// Displacement along a row since the substep's start.
float motion_along(const Work& work, const JointForest::Joint& joint, const Pool& pool, int row) {
  float sum = 0;
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    const Vec3f motion = slot % 2 == 1 ? xyz(work.frames.predicted[n]) + xyz(work.frames.corrections[n])
                                       : xyz(work.points.displacements[n]) - xyz(work.points.remainders[n]);
    sum = sum + dot(work.arrays.gradient(pool, row, slot), motion);
  }
  return sum;
}

/// The rows of a joint: C now, with the gradients of the substep's start or of now.
void fill_rows(Work& work, const JointForest::Joint& joint, bool start_gradients, JointRows& rows) {
  const Pool& pool = work.object.pools[static_cast<std::size_t>(joint.pool)];
  const ConstraintPlace at{pool, joint.pool, joint.batch, joint.lane};
  work.arrays.load_rest(at);
  evaluate(work, joint, false);
  const float softness = at.value(pool.fields), alpha = min(softness * work.points.inverse_h2, largest_compliance);
  const float gamma =
      pool.law == Law::damped ? min(softness * at.value(pool.fields + 1) * work.points.inverse_h, largest_compliance) : 0;
  const float* multipliers = work.points.first_pass ? nullptr : multipliers_of(work, joint);
  rows.rows = pool.components;
  for (int r = 0; r < pool.components; ++r) {
    const auto row = static_cast<std::size_t>(r);
    rows.value[row] = work.arrays.c[r] + (multipliers != nullptr ? alpha * multipliers[r * batch_width] : 0);
    if (gamma > 0) rows.value[row] = (rows.value[row] + gamma * motion_along(work, joint, pool, r)) / (1 + gamma);
    rows.compliance[row] = alpha / (1 + gamma);
  }
  if (start_gradients) evaluate(work, joint, true);
  for (int r = 0; r < pool.components; ++r) {
    const auto row = static_cast<std::size_t>(r);
    rows.of_a[row] = {work.arrays.gradient(pool, r, 0), work.arrays.gradient(pool, r, 1)};
    rows.of_b[row] = {work.arrays.gradient(pool, r, 2), work.arrays.gradient(pool, r, 3)};
  }
}

/// The inertia of a body in world axes: xx, yy, zz, yz, zx, xy.
BodyMass mass_of(const Work& work, const JointForest::Body& body) {
  const Quatf q = quaternion(work.frames.orientations[body.frame]);
  const Vec3f inverse = xyz(work.frames.inverse_inertias[body.frame]);
  const Vec3f axes[3] = {rotate(q, Vec3f{1, 0, 0}), rotate(q, Vec3f{0, 1, 0}), rotate(q, Vec3f{0, 0, 1})};
  const float moments[3] = {1 / inverse.x, 1 / inverse.y, 1 / inverse.z};
  BodyMass mass;
  mass.mass = 1 / work.points.positions[body.point].w;
  for (int k = 0; k < 3; ++k) {
    const Vec3f &u = axes[k], v = axes[k] * moments[k];
    const float terms[6] = {u.x * v.x, u.y * v.y, u.z * v.z, u.y * v.z, u.z * v.x, u.x * v.y};
    for (std::size_t i = 0; i < 6; ++i) mass.inertia[i] = mass.inertia[i] + terms[i];
  }
  return mass;
}

void fill_masses(Work& work) {
  JointForest& forest = work.forest;
  forest.masses.resize(forest.bodies.size());
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) forest.masses[i] = mass_of(work, forest.bodies[i]);
}

void fill_rows(Work& work, bool start_gradients) {
  JointForest& forest = work.forest;
  forest.rows.resize(forest.joints.size());
  for (std::size_t j = 0; j < forest.joints.size(); ++j)
    if (forest.in_tree[j] != 0) fill_rows(work, forest.joints[j], start_gradients, forest.rows[j]);
}

void apply(Work& work) {
  JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const auto& [point, frame] = forest.bodies[i];
    Record& d = work.points.displacements[point];
    const Vec3f& move = forest.corrections[i].displacement;
    d = {d.x + move.x, d.y + move.y, d.z + move.z, 0};
    rotate_frame(forest.corrections[i].rotation, work.frames.orientations[frame], work.frames.corrections[frame]);
  }
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    float* multipliers = forest.in_tree[j] != 0 ? multipliers_of(work, forest.joints[j]) : nullptr;
    for (int row = 0; multipliers != nullptr && row < forest.rows[j].rows; ++row) {
      float& multiplier = multipliers[row * batch_width];  // of the opposite sign in the tree
      multiplier = (work.points.first_pass ? 0.f : multiplier) - forest.multipliers[j][static_cast<std::size_t>(row)];
    }
  }
}

// ---------------------------------------------------------------- geometric stiffness

/// Above this ratio of |joint force h^2| |arm| to a body's inertia, joints turn the body faster than substeps can follow:
/// it is the square of the angle by which the oscillation advances in a substep.
constexpr float largest_advance = 1;

using Symmetric = std::array<float, 6>;  ///< xx, yy, zz, yz, zx, xy

Vec3f times(const Symmetric& m, const Vec3f& v) {
  return {m[0] * v.x + m[5] * v.y + m[4] * v.z, m[5] * v.x + m[1] * v.y + m[3] * v.z, m[4] * v.x + m[3] * v.y + m[2] * v.z};
}

/// The solution of m x = b by cofactors; m is positive definite.
Vec3f solved(const Symmetric& m, const Vec3f& b) {
  const Vec3f r0{m[0], m[5], m[4]}, r1{m[5], m[1], m[3]}, r2{m[4], m[3], m[2]};
  const Vec3f c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  return (c0 * b.x + c1 * b.y + c2 * b.z) * (1 / dot(r0, c0));
}

/// Adds the stiffness against rotation that force f at arm r gives a body: (f.r + |f||r|) / 2 - (f r^T + r f^T) / 2, which
/// is never negative. Returns |f||r|.
float add_stiffness(const Vec3f& f, const Vec3f& r, Symmetric& sum) {
  const float size = sqrt(length_squared(f) * length_squared(r)), half = (dot(f, r) + size) * 0.5f;
  const float terms[6] = {half - f.x * r.x,
                          half - f.y * r.y,
                          half - f.z * r.z,
                          (f.y * r.z + f.z * r.y) * -0.5f,
                          (f.z * r.x + f.x * r.z) * -0.5f,
                          (f.x * r.y + f.y * r.x) * -0.5f};
  for (std::size_t i = 0; i < 6; ++i) sum[i] = sum[i] + terms[i];
  return size;
}

/// Computes the geometric stiffness of all bodies from the multipliers of the last solve. Returns the largest ratio of
/// |f||r| to the mean inertia of a body.
float find_stiffness(Work& work, std::vector<Symmetric>& stiffness) {
  JointForest& forest = work.forest;
  stiffness.assign(forest.bodies.size(), {});
  std::vector<float> sizes(forest.bodies.size(), 0.f);
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    if (forest.in_tree[j] == 0) continue;
    const JointForest::Joint& joint = forest.joints[j];
    const JointRows& rows = forest.rows[j];
    const ConstraintPlace at{work.object.pools[static_cast<std::size_t>(joint.pool)], joint.pool, joint.batch, joint.lane};
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? forest.ends[j].a : forest.ends[j].b;
      if (body < 0) continue;
      const auto& gradients = side == 0 ? rows.of_a : rows.of_b;
      Vec3f force{};
      for (std::size_t row = 0; row < static_cast<std::size_t>(rows.rows); ++row)
        force = force - gradients[row][0] * forest.multipliers[j][row];
      const Vec3f anchor{at.value(3 * side), at.value(3 * side + 1), at.value(3 * side + 2)};
      const std::int32_t frame = joint.slots[static_cast<std::size_t>(2 * side + 1)];
      const auto b = static_cast<std::size_t>(body);
      sizes[b] += add_stiffness(force, rotate(quaternion(work.frames.orientations[frame]), anchor), stiffness[b]);
    }
  }
  float largest = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Symmetric& inertia = forest.masses[i].inertia;
    largest = max(largest, sizes[i] * 3 / (inertia[0] + inertia[1] + inertia[2]));
  }
  return largest;
}

/// Adds the stiffness to the inertia, and takes away the part of the predicted rotation that it prevents.
void stiffen(Work& work, const std::vector<Symmetric>& stiffness) {
  JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const std::int32_t frame = forest.bodies[i].frame;
    Symmetric& inertia = forest.masses[i].inertia;
    for (std::size_t k = 0; k < 6; ++k) inertia[k] = inertia[k] + stiffness[i][k];
    if (!work.points.first_pass) continue;
    const Vec3f predicted = xyz(work.frames.predicted[frame]);
    rotate_frame(-solved(inertia, times(stiffness[i], predicted)), work.frames.orientations[frame],
                 work.frames.corrections[frame]);
  }
}

void solve(Work& work) {
  JointForest& forest = work.forest;
  forest.tree->solve(forest.masses, forest.rows, forest.corrections, &forest.multipliers);
}

void solve_object(Work work) {
  JointForest& forest = work.forest;
  fill_masses(work);
  fill_rows(work, true);
  solve(work);
  if (find_stiffness(work, forest.stiffness) > largest_advance) {
    stiffen(work, forest.stiffness);
    fill_rows(work, false);
    solve(work);
  }
  apply(work);
}

}  // namespace

void prepare_joints(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, JointForest& forest) {
  forest = {};
  find_joints(object, is_broken, forest);
  if (!forest.joints.empty()) {
    forest.tree.emplace(static_cast<int>(forest.bodies.size()), forest.ends);
    forest.in_tree.assign(forest.joints.size(), 1);
    for (const int loose : forest.tree->loose()) forest.in_tree[static_cast<std::size_t>(loose)] = 0;
  }
  mark_skipped(object, is_broken, forest);
}

void solve_joint_trees(Substep& s, bool first_pass) {
  std::vector<int> objects;
  for_objects(s, [&](int o) {
    if (s.work.joints[static_cast<std::size_t>(o)].forest.tree) objects.push_back(o);
  });
  if (objects.empty()) return;
  for_tasks(s, "solve: joints", static_cast<int>(objects.size()), [&](int task) {
    const int o = objects[static_cast<std::size_t>(task)];
    solve_object({s.model.objects[static_cast<std::size_t>(o)], arguments(s, o, first_pass), frame_arguments(s, o),
                  s.work.joints[static_cast<std::size_t>(o)].forest});
  });
}

}  // namespace pliant
