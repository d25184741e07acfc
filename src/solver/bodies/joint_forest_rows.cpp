// Sets the rows and masses of joint trees.
#include <algorithm>

#include "constraints/registry.h"
#include "math/quat.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/joint_forest_work.h"
#include "solver/bodies/joint_formulas.h"
#include "solver/damper.h"
#include "solver/project.h"
#include "solver/stencil.h"

namespace pliant {

namespace {

using BoundedRow = JointForest::BoundedRow;
using RowState = BoundedRow::State;

/// Sets the slots of a joint to the positions at the substep's start, or now.
void load(JointWork& work, const JointForest::Joint& joint, bool at_start) {
  load_slots(work, joint, at_start ? work.points.remainders : work.points.displacements,
             at_start ? work.frames.starts : work.frames.orientations);
}

/// A rigid stop brings back what is beyond it at this speed [m/s or rad/s]: a joint may begin far outside of its range.
constexpr float speed_of_return = 1;

/// True if a row with bounds is a stop whose C is on the side where it pushes.
bool is_beyond(float c, const float* bounds) { return c < 0 ? bounds[0] >= 0 : c > 0 && bounds[1] <= 0; }

/// What a stop is to take away of C now, if C was `start` when the substep began.
float within_reach(float now, float start, const float* bounds, float h) {
  const float most = speed_of_return * h;
  if (!is_beyond(now, bounds) || !is_beyond(start, bounds) || start * now < 0 || abs(start) <= most) return now;
  return now - (start - (start < 0 ? -most : most));
}

/// The displacement along a row since the substep's start.
float motion_along(const JointWork& work, const JointForest::Joint& joint, const Pool& pool, int row) {
  float sum = 0;
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    const Vec3f motion = slot % 2 == 1 ? xyz(work.frames.predicted[n]) + xyz(work.frames.corrections[n])
                                       : xyz(work.points.displacements[n]) - xyz(work.points.remainders[n]);
    sum = sum + dot(work.arrays.gradient(pool, row, slot), motion);
  }
  return sum;
}

/// The same at the velocities of the substep's start.
float coast_along(const JointWork& work, const JointForest::Joint& joint, const Pool& pool, int row) {
  float sum = 0;
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    const Vec3f motion = slot % 2 == 1 ? xyz(work.frames.predicted[n]) : coast_of(work.points, n);
    sum = sum + dot(work.arrays.gradient(pool, row, slot), motion);
  }
  return sum;
}

/// J M^-1 J^T of a row of a joint.
float inverse_mass_of(const JointWork& work, const JointForest::Joint& joint, const Pool& pool, int row) {
  float sum = 0;
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    const Vec3f g = work.arrays.gradient(pool, row, slot);
    if (slot % 2 == 0) {
      sum = sum + work.points.positions[n].w * length_squared(g);
      continue;
    }
    const Vec3f own = rotate(conjugate(quaternion(work.frames.orientations[n])), g),
                w = xyz(work.frames.inverse_inertias[n]);
    sum = sum + (w.x * own.x * own.x + w.y * own.y * own.y + w.z * own.z * own.z);
  }
  return sum;
}

/// How a row with compliance over h^2 `alpha` takes the mean of forces.
energy_law::Shares<float> mean_of(const JointWork& work, const JointForest::Joint& joint, const Pool& pool, int row,
                                  float alpha) {
  const float moves = length_squared(work.arrays.gradient(pool, row, 2));
  return energy_law::shares_of(alpha, inverse_mass_of(work, joint, pool, row), energy_law::most_of_tree(moves));
}

/// What a row of a joint with compliance has besides C and its multiplier.
struct Response {
  float alpha = 0, gamma = 0;  ///< compliance over h^2; damping over h
  float share = 1;             ///< of the substep's motion, along which C changes
  float past = 0;              ///< is added to C
};

/// Of what was evaluated last. A stop knows only of the substep's motion. A spring keeps motion by any integrator, and
/// its damping is of the second order.
Response response_of(const JointWork& work, const JointForest::Joint& joint, const ConstraintPlace& at, int row) {
  const bool is_bounded = constraint_type(at.pool.type).evaluate_bounded != nullptr;
  const bool is_spring = is_bounded && acts_both_ways(work.bounds[3 * row], work.bounds[3 * row + 1]);
  const float softness = at.value(at.pool.fields);
  Response response;
  response.alpha = min(softness * work.points.inverse_h2, largest_compliance);
  if (!(response.alpha > 0)) return response;
  if (at.pool.law == Law::damped)
    response.gamma = min(softness * at.value(at.pool.fields + 1) * work.points.inverse_h, largest_compliance);
  const bool keeps_motion = is_spring || (!is_bounded && work.points.keeps_energy);
  const auto mean = keeps_motion ? mean_of(work, joint, at.pool, row, response.alpha) : energy_law::Shares<float>{0, 0};
  if (!(response.gamma > 0) && !(mean.motion > 0)) return response;
  const float share = viscous_share(response.gamma, 1 - mean.motion - mean.coast);
  const ViscousWeights viscous =
      is_spring ? viscous_weights(share, inverse_mass_of(work, joint, at.pool, row) / response.alpha)
                : ViscousWeights{share, 0};
  const float by_motion = viscous.motion - mean.motion, by_coast = viscous.coast - mean.coast;
  response.share = 1 + by_motion;
  response.past = by_motion * motion_along(work, joint, at.pool, row);
  if (by_coast != 0) response.past = response.past + by_coast * coast_along(work, joint, at.pool, row);
  return response;
}

/// Adds a row to the bounded ones. A stop that is not reached starts at its bound, so that it does not act.
void add_bounded(JointWork& work, std::size_t j, std::size_t row, int of_part, float before, const JointRows& rows) {
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
void fill_part(JointWork& work, std::size_t j, const JointForest::Part& part, bool start_gradients, std::size_t first) {
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
  const float softness = at.value(pool.fields);
  const bool is_stop = type.evaluate_bounded != nullptr && !type.acts_on_motion && softness == 0;
  if (start_gradients || is_stop) {
    load(work, joint, true);
    evaluate(work, type);
    for (int r = 0; is_stop && r < pool.components; ++r)
      c[r] = within_reach(c[r], work.arrays.c[r], bounds + 3 * r, work.points.h);
  }
  if (!start_gradients && is_stop) {
    load(work, joint, false);
    evaluate(work, type);
  }
  std::copy_n(bounds, 3 * most_components, work.bounds);
  const float* multipliers = work.points.first_pass ? nullptr : multipliers_of(work, at);
  for (int r = 0; r < pool.components; ++r) {
    const std::size_t row = first + static_cast<std::size_t>(r);
    const float before = multipliers != nullptr ? multipliers[r * batch_width] : 0;
    rows.of_a[row] = {work.arrays.gradient(pool, r, 0), work.arrays.gradient(pool, r, 1)};
    rows.of_b[row] = {work.arrays.gradient(pool, r, 2), work.arrays.gradient(pool, r, 3)};
    if (type.acts_on_motion) {
      const float alpha = min(softness * work.points.inverse_h, largest_compliance);
      const float coast = alpha > 0 ? coast_along(work, joint, pool, r) : 0,
                  mass = alpha > 0 ? inverse_mass_of(work, joint, pool, r) : 0;
      const DampedRow damped = damped_row(alpha, mass, work.bounds[3 * r + 2] * work.points.h, coast);
      rows.value[row] = motion_along(work, joint, pool, r) - damped.target + damped.compliance * before;
      rows.compliance[row] = damped.compliance;
    } else {
      const Response response = response_of(work, joint, at, r);
      rows.value[row] = (c[r] + response.alpha * before + response.past) / response.share;
      rows.compliance[row] = response.alpha / response.share;
    }
    if (type.evaluate_bounded != nullptr) add_bounded(work, j, row, r, before, rows);
  }
}

/// Of a body whose centre is pinned [kg]: it rotates, and does not move.
constexpr float mass_of_held = 1e20f;

BodyMass mass_of(const JointWork& work, const JointForest::Body& body) {
  float inertia[6], inverse[6];
  joint_formulas::turned_inertia(quaternion(work.frames.orientations[body.frame]),
                                 xyz(work.frames.inverse_inertias[body.frame]), inertia, inverse);
  const float w = work.points.positions[body.point].w;
  BodyMass mass;
  mass.mass = w > 0 ? 1 / w : mass_of_held;
  std::copy_n(inertia, 6, mass.inertia.begin());
  std::copy_n(inverse, 6, mass.inverse.begin());
  return mass;
}

}  // namespace

ConstraintPlace place_of(const JointWork& work, const JointForest::Part& part) {
  return {work.object.pools[static_cast<std::size_t>(part.pool)], part.pool, part.batch, part.lane};
}

float* multipliers_of(const JointWork& work, const ConstraintPlace& at) {
  float* all = work.points.multipliers == nullptr ? nullptr : work.points.multipliers[at.pool_number];
  return all == nullptr ? nullptr : all + at.multiplier_place(0);
}

void load_slots(JointWork& work, const JointForest::Joint& joint, const Record* displacements,
                const Record* orientations) {
  const std::int32_t origin = joint.slots[0];
  for (int slot = 0; slot < 4; ++slot) {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    if (slot % 2 == 1) {
      const Record& q = orientations[n];
      work.arrays.set_slot(slot, q.x, q.y, q.z, q.w);
      continue;
    }
    const Vec3f x = (xyz(work.points.positions[n]) - xyz(work.points.positions[origin])) +
                    (xyz(displacements[n]) - xyz(displacements[origin]));
    work.arrays.set_slot(slot, x.x, x.y, x.z, 0);
  }
}

void evaluate(JointWork& work, const ConstraintDefinition& type) {
  StencilArrays<float>& a = work.arrays;
  if (type.evaluate_bounded != nullptr)
    type.evaluate_bounded(a.slots, a.rest, a.c, a.gradients, work.bounds);
  else
    type.evaluate(a.slots, a.rest, a.c, a.gradients);
}

void fill_rows(JointWork& work, bool start_gradients) {
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

namespace {

/// True if the residual of a row of a joint with compliance, C + alpha lambda with damping, is above `most` [m],
/// divided by the gradient at b's point. Rows that only turn bodies do not count.
bool is_displaced(const JointWork& work, const JointForest::Joint& joint, const ConstraintPlace& at, float most) {
  const float* multipliers = multipliers_of(work, at);
  for (int r = 0; r < at.pool.components; ++r) {
    const float squared = length_squared(work.arrays.gradient(at.pool, r, 2));
    const Response response = response_of(work, joint, at, r);
    const float elastic = multipliers == nullptr ? 0 : response.alpha * multipliers[r * batch_width];
    const float error = work.arrays.c[r] + elastic + response.past;
    if (error * error > most * most * squared && squared > 0) return true;
  }
  return false;
}

}  // namespace

bool is_open(JointWork& work, float share) {
  using joint_formulas::least_gap, joint_formulas::open_share_of_soft;
  for (const JointForest::Joint& joint : work.forest.joints) {
    if (!joint.in_tree) continue;
    const ConstraintPlace at = place_of(work, joint.parts.front());
    work.arrays.load_rest(at);
    load(work, joint, false);
    evaluate(work, constraint_type(at.pool.type));
    const float* rest = work.arrays.rest;  // begins with the anchors in a and in b
    const float size =
        sqrt(length_squared(Vec3f{rest[0], rest[1], rest[2]})) + sqrt(length_squared(Vec3f{rest[3], rest[4], rest[5]}));
    if (at.value(at.pool.fields) > 0) {
      if (is_displaced(work, joint, at, max(least_gap, open_share_of_soft * size))) return true;
      continue;
    }
    const float most = max(least_gap, share * min(size, 1.f));
    for (int r = 0; r < at.pool.components; ++r)
      if (abs(work.arrays.c[r]) > most) return true;
  }
  return false;
}

void fill_masses(JointWork& work) {
  JointForest& forest = work.forest;
  forest.masses.resize(forest.bodies.size());
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) forest.masses[i] = mass_of(work, forest.bodies[i]);
}

}  // namespace pliant
