// Solves the trees of joints of an object in a substep.
#include <algorithm>

#include "constraints/registry.h"
#include "math/quat.h"
#include "solver/bodies/joint_forest.h"
#include "solver/project.h"
#include "solver/stencil.h"
#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

namespace {

using BoundedRow = JointForest::BoundedRow;
using RowState = BoundedRow::State;

Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }
Quatf quaternion(const Record& r) { return {r.x, r.y, r.z, r.w}; }

/// The arrays of an object, and one constraint at a time.
struct Work {
  const CompiledObject& object;
  SweepArguments points;
  FrameArguments frames;
  JointForest& forest;
  StencilArrays<float> arrays{};
  float bounds[3 * most_components] = {};  ///< of each row: low, high, speed
};

ConstraintPlace place_of(const Work& work, const JointForest::Part& part) {
  return {work.object.pools[static_cast<std::size_t>(part.pool)], part.pool, part.batch, part.lane};
}

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

void evaluate(Work& work, const ConstraintDefinition& type) {
  StencilArrays<float>& a = work.arrays;
  if (type.evaluate_bounded != nullptr)
    type.evaluate_bounded(a.slots, a.rest, a.c, a.gradients, work.bounds);
  else
    type.evaluate(a.slots, a.rest, a.c, a.gradients);
}

/// The multipliers of a constraint, sixteen apart; null if none are stored.
float* multipliers_of(const Work& work, const ConstraintPlace& at) {
  float* all = work.points.multipliers == nullptr ? nullptr : work.points.multipliers[at.pool_number];
  return all == nullptr ? nullptr : all + at.multiplier_place(0);
}

/// The displacement along a row since the substep's start.
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

/// Adds a row to the bounded ones. A stop that is not reached starts at its bound, so that it does not act.
void add_bounded(Work& work, std::size_t j, std::size_t row, int of_part, float before, const JointRows& rows) {
  const float h2 = work.points.h * work.points.h;
  BoundedRow bounded{j,
                     row,
                     work.bounds[3 * of_part] * h2 - before,
                     work.bounds[3 * of_part + 1] * h2 - before,
                     rows.value[row],
                     rows.compliance[row],
                     0,
                     RowState::free};
  if (rows.value[row] > 0 && bounded.low >= 0) bounded.state = RowState::low;
  if (rows.value[row] < 0 && bounded.high <= 0) bounded.state = RowState::high;
  work.forest.bounded.push_back(bounded);
}

/// The rows of one constraint of a joint, from row `first` on.
void fill_part(Work& work, std::size_t j, const JointForest::Part& part, bool start_gradients, std::size_t first) {
  const JointForest::Joint& joint = work.forest.joints[j];
  JointRows& rows = work.forest.rows[j];
  const ConstraintPlace at = place_of(work, part);
  const Pool& pool = at.pool;
  const ConstraintDefinition& type = constraint_type(pool.type);
  work.arrays.load_rest(at);
  load(work, joint, false);
  evaluate(work, type);
  float c[most_components], bounds[3 * most_components];
  std::copy_n(work.arrays.c, most_components, c);
  std::copy_n(work.bounds, 3 * most_components, bounds);
  if (start_gradients) {
    load(work, joint, true);
    evaluate(work, type);
    std::copy_n(bounds, 3 * most_components, work.bounds);
  }
  const float softness = at.value(pool.fields),
              alpha = min(softness * (type.acts_on_motion ? work.points.inverse_h : work.points.inverse_h2),
                          largest_compliance),
              gamma = pool.law == Law::damped && !type.acts_on_motion
                          ? min(softness * at.value(pool.fields + 1) * work.points.inverse_h, largest_compliance)
                          : 0;
  const float* multipliers = work.points.first_pass ? nullptr : multipliers_of(work, at);
  for (int r = 0; r < pool.components; ++r) {
    const std::size_t row = first + static_cast<std::size_t>(r);
    const float before = multipliers != nullptr ? multipliers[r * batch_width] : 0;
    rows.of_a[row] = {work.arrays.gradient(pool, r, 0), work.arrays.gradient(pool, r, 1)};
    rows.of_b[row] = {work.arrays.gradient(pool, r, 2), work.arrays.gradient(pool, r, 3)};
    const bool needs_motion = type.acts_on_motion || gamma > 0;
    const float motion = needs_motion ? motion_along(work, joint, pool, r) : 0;
    const float error = type.acts_on_motion ? motion - work.bounds[3 * r + 2] * work.points.h : c[r];
    rows.value[row] = (error + alpha * before + gamma * motion) / (1 + gamma);
    rows.compliance[row] = alpha / (1 + gamma);
    if (type.evaluate_bounded != nullptr) add_bounded(work, j, row, r, before, rows);
  }
}

void fill_rows(Work& work, bool start_gradients) {
  JointForest& forest = work.forest;
  forest.rows.resize(forest.joints.size());
  forest.bounded.clear();
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    if (!forest.joints[j].in_tree) continue;
    std::size_t row = 0;
    for (const JointForest::Part& part : forest.joints[j].parts) {
      fill_part(work, j, part, start_gradients, row);
      row += static_cast<std::size_t>(work.object.pools[static_cast<std::size_t>(part.pool)].components);
    }
    forest.rows[j].rows = static_cast<int>(row);
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

// ---------------------------------------------------------------- bounds

/// A row whose multiplier is held at a bound is a row of this compliance, in units of its inverse mass.
constexpr float held_compliance = 1e6f;
/// A bound beyond this is none.
constexpr float most_held = 1e15f;
/// Solves with rows that may leave their bounds again, then solves in which they may only reach them.
constexpr int free_rounds = 4, most_rounds = 10;

/// J M^-1 J^T of a row, with the mean inertia of each body: a scale.
float inverse_mass(const JointForest& forest, const BoundedRow& bounded) {
  const JointRows& rows = forest.rows[bounded.joint];
  const JointEnds& ends = forest.ends[bounded.joint];
  float sum = 0;
  for (const auto& [body, g] : {std::pair{ends.a, rows.of_a[bounded.row]}, std::pair{ends.b, rows.of_b[bounded.row]}}) {
    if (body < 0) continue;
    const BodyMass& mass = forest.masses[static_cast<std::size_t>(body)];
    sum = sum + length_squared(g[0]) / mass.mass +
          length_squared(g[1]) * 3 / (mass.inertia[0] + mass.inertia[1] + mass.inertia[2]);
  }
  return max(sum, smallest_denominator);
}

float held_change(const BoundedRow& bounded) { return bounded.state == RowState::low ? bounded.low : bounded.high; }

/// Writes a bounded row as it is in its state.
void write_row(JointForest& forest, const BoundedRow& bounded) {
  JointRows& rows = forest.rows[bounded.joint];
  const bool is_free = bounded.state == RowState::free;
  const float compliance = held_compliance * bounded.inverse_mass;
  rows.compliance[bounded.row] = is_free ? bounded.compliance : compliance;
  rows.value[bounded.row] = is_free ? bounded.value : -compliance * held_change(bounded);
}

/// What is left of a row's C after the corrections, with compliance.
float residual(const JointForest& forest, const BoundedRow& bounded, float change) {
  const JointRows& rows = forest.rows[bounded.joint];
  const JointEnds& ends = forest.ends[bounded.joint];
  float sum = bounded.value + bounded.compliance * change;
  for (const auto& [body, g] : {std::pair{ends.a, rows.of_a[bounded.row]}, std::pair{ends.b, rows.of_b[bounded.row]}}) {
    if (body < 0) continue;
    const BodyCorrection& by = forest.corrections[static_cast<std::size_t>(body)];
    sum = sum + dot(g[0], by.displacement) + dot(g[1], by.rotation);
  }
  return sum;
}

/// The state of a bounded row after a solve. A row that depends on others is left out of the solve; if it is not met, it
/// is held at the bound that would reduce its error.
RowState next_state(const JointForest& forest, const BoundedRow& bounded, bool may_leave) {
  const float tolerance = 1e-7f + 1e-4f * abs(bounded.value);
  if (bounded.state != RowState::free) {
    const float left = residual(forest, bounded, held_change(bounded));
    const bool leaves = bounded.state == RowState::low ? left < -tolerance : left > tolerance;
    return leaves && may_leave && bounded.low < bounded.high ? RowState::free : bounded.state;
  }
  const float change = -forest.multipliers[bounded.joint][bounded.row];
  if (change < bounded.low) return RowState::low;
  if (change > bounded.high) return RowState::high;
  const float left = residual(forest, bounded, change);
  if (left > tolerance && bounded.low > -most_held) return RowState::low;
  return left < -tolerance && bounded.high < most_held ? RowState::high : RowState::free;
}

/// True if the solve left a row out because it depends on others, as a motor against a stop does, and it is not met.
bool is_left_out(const JointForest& forest, const BoundedRow& bounded) {
  if (bounded.state != RowState::free || forest.multipliers[bounded.joint][bounded.row] != 0) return false;
  return abs(residual(forest, bounded, 0)) > 1e-7f + 1e-4f * abs(bounded.value);
}

void solve_once(JointForest& forest) {
  forest.tree->solve(forest.masses, forest.rows, forest.corrections, &forest.multipliers);
}

/// Solves until no bounded row changes its state.
void solve(JointForest& forest) {
  for (BoundedRow& bounded : forest.bounded) {
    bounded.inverse_mass = inverse_mass(forest, bounded);
    write_row(forest, bounded);
  }
  for (int round = 0; round < most_rounds; ++round) {
    solve_once(forest);
    bool changes = false;
    const auto left_out = [&](const BoundedRow& bounded) { return is_left_out(forest, bounded); };
    const bool is_partial = std::any_of(forest.bounded.begin(), forest.bounded.end(), left_out);
    for (BoundedRow& bounded : forest.bounded) {
      if (is_partial && !left_out(bounded)) continue;  // what the others do follows from those that were left out
      const RowState next = next_state(forest, bounded, round < free_rounds);
      changes = changes || next != bounded.state;
      bounded.state = next;
    }
    if (!changes) break;
    for (const BoundedRow& bounded : forest.bounded) write_row(forest, bounded);
  }
  for (const BoundedRow& bounded : forest.bounded)
    if (bounded.state != RowState::free) forest.multipliers[bounded.joint][bounded.row] = -held_change(bounded);
}

// ---------------------------------------------------------------- geometric stiffness

/// Above this ratio of |joint force h^2| |arm| to a body's inertia, joints turn the body faster than substeps can follow:
/// it is the square of the angle by which the oscillation advances in a substep.
constexpr float largest_advance = 0.25f;

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
/// |f||r| to the mean inertia of a body. The rest data of joints begin with the anchor in a, then in b.
float find_stiffness(Work& work) {
  JointForest& forest = work.forest;
  forest.stiffness.assign(forest.bodies.size(), {});
  std::vector<float> sizes(forest.bodies.size(), 0.f);
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    const JointForest::Joint& joint = forest.joints[j];
    if (!joint.in_tree) continue;
    const JointRows& rows = forest.rows[j];
    const ConstraintPlace at = place_of(work, joint.parts.front());
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? forest.ends[j].a : forest.ends[j].b;
      if (body < 0) continue;
      const auto& gradients = side == 0 ? rows.of_a : rows.of_b;
      Vec3f force{};
      const float* before = work.points.first_pass ? nullptr : multipliers_of(work, at);
      for (std::size_t row = 0; row < static_cast<std::size_t>(rows.rows); ++row) {
        const bool has_before = before != nullptr && static_cast<int>(row) < at.pool.components;
        const float earlier = has_before ? before[row * batch_width] : 0;  // in earlier passes of the substep
        force = force + gradients[row][0] * (earlier - forest.multipliers[j][row]);
      }
      const Vec3f anchor{at.value(3 * side), at.value(3 * side + 1), at.value(3 * side + 2)};
      const std::int32_t frame = joint.slots[2 * static_cast<std::size_t>(side) + 1];
      const auto b = static_cast<std::size_t>(body);
      const Vec3f arm = rotate(quaternion(work.frames.orientations[frame]), anchor);
      sizes[b] = sizes[b] + add_stiffness(force, arm, forest.stiffness[b]);
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
void stiffen(Work& work) {
  JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const std::int32_t frame = forest.bodies[i].frame;
    Symmetric& inertia = forest.masses[i].inertia;
    for (std::size_t k = 0; k < 6; ++k) inertia[k] = inertia[k] + forest.stiffness[i][k];
    if (!work.points.first_pass) continue;
    const Vec3f predicted = xyz(work.frames.predicted[frame]);
    rotate_frame(-solved(inertia, times(forest.stiffness[i], predicted)), work.frames.orientations[frame],
                 work.frames.corrections[frame]);
  }
}

// ---------------------------------------------------------------- an object

void store_multipliers(Work& work) {
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

void apply(Work& work) {
  const JointForest& forest = work.forest;
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const auto& [point, frame] = forest.bodies[i];
    Record& d = work.points.displacements[point];
    const Vec3f& move = forest.corrections[i].displacement;
    d = {d.x + move.x, d.y + move.y, d.z + move.z, 0};
    rotate_frame(forest.corrections[i].rotation, work.frames.orientations[frame], work.frames.corrections[frame]);
  }
  store_multipliers(work);
}

/// The largest C of a rigid joint [m or rad].
float largest_gap(const Work& work) {
  float largest = 0;
  for (std::size_t j = 0; j < work.forest.joints.size(); ++j) {
    const JointForest::Joint& joint = work.forest.joints[j];
    if (!joint.in_tree) continue;
    const JointRows& rows = work.forest.rows[j];
    const int own = work.object.pools[static_cast<std::size_t>(joint.parts.front().pool)].components;
    for (std::size_t r = 0; r < static_cast<std::size_t>(own); ++r)
      if (rows.compliance[r] == 0) largest = max(largest, abs(rows.value[r]));
  }
  return largest;
}

/// Solves the trees of an object. Returns false, and changes nothing, if no joint is off by more than a tolerance [m or rad].
bool solve_object(Work& work, float tolerance) {
  fill_masses(work);
  fill_rows(work, true);
  if (tolerance > 0 && !(largest_gap(work) > tolerance)) return false;
  solve(work.forest);
  if (find_stiffness(work) > largest_advance) {
    stiffen(work);
    fill_rows(work, false);
    solve(work.forest);
  }
  apply(work);
  return true;
}

/// Calls a function for the trees of each object that takes part.
void for_trees(Substep& s, bool first_pass, FunctionRef<void(Work&)> body) {
  std::vector<int> objects;
  for_objects(s, [&](int o) {
    if (s.work.joints[static_cast<std::size_t>(o)].forest != nullptr) objects.push_back(o);
  });
  if (objects.empty()) return;
  for_tasks(s, "solve: joints", static_cast<int>(objects.size()), [&](int task) {
    const int o = objects[static_cast<std::size_t>(task)];
    Work work{s.model.objects[static_cast<std::size_t>(o)], arguments(s, o, first_pass), frame_arguments(s, o),
              *s.work.joints[static_cast<std::size_t>(o)].forest};
    body(work);
  });
}

/// Contact moves one body of a tree at a time, so a joint is open by what an impact gives it in a substep; gaps above this are closed.
constexpr float closed = 1e-6f;
/// Each round leaves a gap of the order of the square of the last one over the length of a body.
constexpr int most_closing_rounds = 3;

}  // namespace

void solve_joint_trees(Substep& s, bool first_pass) {
  for_trees(s, first_pass, [](Work& work) { (void)solve_object(work, 0); });
}

void close_joint_trees(Substep& s) {
  for_trees(s, false, [](Work& work) {
    for (int round = 0; round < most_closing_rounds; ++round)
      if (!solve_object(work, closed)) return;
  });
}

}  // namespace pliant
