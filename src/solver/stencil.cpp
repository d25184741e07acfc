#include "solver/stencil.h"

#include "constraints/registry.h"
#include "math/quat.h"
#include "math/record.h"
#include "solver/bodies/joint_formulas.h"
#include "solver/bodies/tied_body.h"
#include "solver/damper.h"
#include "solver/project.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// A pivot below this share of its diagonal entry is rounding error. Its row then depends linearly on earlier rows and
/// is ignored.
constexpr float least_pivot = 1e-6f;

/// The generalised inverse mass W of one slot. It maps a gradient to a displacement, or to a rotation vector.
struct SlotMass {
  bool is_frame = false;
  float inverse_mass = 0;
  Quatf orientation{};
  Vec3f inverse_inertia{};

  Vec3f times(const Vec3f& g) const {
    if (!is_frame) return g * inverse_mass;
    const Vec3f local = rotate(conjugate(orientation), g);
    return rotate(orientation,
                  Vec3f{local.x * inverse_inertia.x, local.y * inverse_inertia.y, local.z * inverse_inertia.z});
  }
};

/// Scratch memory for the projection of one constraint.
struct Work {
  StencilArrays<float> arrays;
  SlotMass mass[most_slots];
  Vec3f motion[most_slots];  ///< of each slot since the substep's start: displacement [m] or rotation [rad]
  Vec3f coast[most_slots];   ///< likewise, by the velocity of the start
  float matrix[most_components][most_components];  ///< A, then its factors: D on the diagonal, L below it
  float change[most_components];                   ///< right-hand side, then dlambda
  float bounds[3 * most_components];               ///< of bounded types, for each row: low, high, speed
};

void load(const CompiledObject& object, const SweepArguments& a, const FrameArguments& f, const Pool& pool,
          const std::int32_t* number, Work& work) {
  int origin = -1;
  for (int slot = 0; slot < pool.stencil; ++slot) {
    const std::int32_t n = number[slot];
    SlotMass& mass = work.mass[slot];
    mass.is_frame = n >= object.particles;
    if (mass.is_frame) {
      const std::int32_t frame = n - object.particles;
      const Record& q = f.orientations[frame];
      work.arrays.set_slot(slot, q.x, q.y, q.z, q.w);
      mass.orientation = quaternion(q);
      mass.inverse_inertia = xyz(f.inverse_inertias[frame]);
      work.motion[slot] = xyz(f.predicted[frame]) + xyz(f.corrections[frame]);
      work.coast[slot] = xyz(f.predicted[frame]);
      continue;
    }
    if (origin < 0) origin = n;
    const Record &p = a.positions[n], &d = a.displacements[n], &r = a.remainders[n];
    const Record &o = a.positions[origin], &first = a.displacements[origin];
    if (n == origin)
      work.arrays.set_slot(slot, 0, 0, 0, 0);
    else
      work.arrays.set_slot(slot, ((p.x - o.x) + d.x) - first.x, ((p.y - o.y) + d.y) - first.y,
                           ((p.z - o.z) + d.z) - first.z, 0);
    mass.inverse_mass = p.w;
    work.motion[slot] = {d.x - r.x, d.y - r.y, d.z - r.z};
    work.coast[slot] = a.velocities == nullptr ? Vec3f{0, 0, 0} : coast_of(a, n);
  }
}

/// Element (i, j) of the matrix A that stencil.h defines.
float coupling(const Pool& pool, const Work& work, int i, int j) {
  float sum = 0;
  for (int slot = 0; slot < pool.stencil; ++slot) {
    const Vec3f g = work.arrays.gradient(pool, i, slot), other = work.arrays.gradient(pool, j, slot);
    const SlotMass& mass = work.mass[slot];
    const float term = mass.is_frame ? dot(g, mass.times(other)) : mass.inverse_mass * dot(g, other);
    sum = slot == 0 ? term : sum + term;
  }
  return sum;
}

/// A row's gradients times the motion of its slots.
float along(const Pool& pool, const Work& work, int row, const Vec3f (&motion)[most_slots]) {
  float sum = dot(work.arrays.gradient(pool, row, 0), motion[0]);
  for (int slot = 1; slot < pool.stencil; ++slot) sum = sum + dot(work.arrays.gradient(pool, row, slot), motion[slot]);
  return sum;
}
float motion_along(const Pool& pool, const Work& work, int row) { return along(pool, work, row, work.motion); }

/// True if every row pulls both ways, as a joint or a spring does, and no stop.
bool pulls(const Pool& pool, const ConstraintDefinition& type, const Work& work) {
  for (int i = 0; i < pool.components && type.evaluate_bounded != nullptr; ++i)
    if (!acts_both_ways(work.bounds[3 * i], work.bounds[3 * i + 1])) return false;
  return true;
}

/// The weights in the force of the displacement in the substep, and of that at the velocity of its start: of the mean
/// of forces and of damping, equal in all rows, so that the matrix is symmetric. A spring keeps motion by any integrator,
/// and its damping is of the second order.
ViscousWeights weights_of(const Pool& pool, const Work& work, const SweepArguments& a, const Yielding& yielding) {
  const ConstraintDefinition& type = constraint_type(pool.type);
  const bool is_bounded = type.evaluate_bounded != nullptr;
  const bool is_mean = (a.keeps_energy || is_bounded) && yielding.compliance > 0;
  if (!is_mean && !(yielding.damping > 0)) return {};
  const bool pulls_both_ways = pulls(pool, type, work);
  float mass = 0;
  for (int i = 0; i < pool.components; ++i) mass = max(mass, coupling(pool, work, i, i));
  const auto mean = is_mean && pulls_both_ways
                        ? energy_law::shares_of(yielding.compliance, mass, energy_law::most_of_sweep)
                        : energy_law::Shares<float>{0, 0};
  const float share = viscous_share(yielding.damping, 1 - mean.motion - mean.coast);
  const bool is_spring = is_bounded && pulls_both_ways && yielding.compliance > 0;
  const ViscousWeights viscous =
      is_spring ? viscous_weights(share, mass / yielding.compliance) : ViscousWeights{share, 0};
  return {viscous.motion - mean.motion, viscous.coast - mean.coast};
}

/// Computes the matrix and the right-hand side for the law of the constraint's pool.
void assemble(const ConstraintPlace& at, const float* multipliers, const SweepArguments& a, Work& work) {
  const Pool& pool = at.pool;
  const Yielding yielding = yielding_of(at, a);
  const ViscousWeights by = weights_of(pool, work, a, yielding);
  for (int i = 0; i < pool.components; ++i) {
    float& rhs = work.change[i];
    rhs = pool.law == Law::pbd ? -(at.value(pool.fields) * work.arrays.c[i]) : -work.arrays.c[i];
    if (multipliers != nullptr && !a.first_pass) rhs = rhs - yielding.compliance * multipliers[i * batch_width];
    if (by.motion != 0) rhs = rhs - by.motion * motion_along(pool, work, i);
    if (by.coast != 0) rhs = rhs - by.coast * along(pool, work, i, work.coast);
    for (int j = 0; j <= i; ++j) {
      const float mass = coupling(pool, work, i, j);
      work.matrix[i][j] = i == j ? mass + yielding.compliance : mass;
      if (by.motion != 0) work.matrix[i][j] = work.matrix[i][j] + by.motion * mass;
    }
  }
}

/// For types that act on motion: C becomes the displacement of C since the substep's start less that at the imposed
/// speed. The compliance is a speed over a force; with it, the row is a damper.
void assemble_motion(const ConstraintPlace& at, const float* multipliers, const SweepArguments& a, Work& work) {
  const Pool& pool = at.pool;
  const float compliance = pool.law == Law::pbd ? 0 : min(at.value(pool.fields) * a.inverse_h, largest_compliance);
  for (int i = 0; i < pool.components; ++i) {
    const float mass = coupling(pool, work, i, i);
    const DampedRow row = damped_row(compliance, mass, work.bounds[3 * i + 2] * a.h,
                                     compliance > 0 ? along(pool, work, i, work.coast) : 0);
    work.change[i] = row.target - motion_along(pool, work, i);
    if (multipliers != nullptr && !a.first_pass)
      work.change[i] = work.change[i] - row.compliance * multipliers[i * batch_width];
    for (int j = 0; j < i; ++j) work.matrix[i][j] = coupling(pool, work, i, j);
    work.matrix[i][i] = mass + row.compliance;
  }
}

/// Clamps the changes of a bounded type, so that each multiplier stays within its row's bounds. A force F has the
/// multiplier F h^2. Without stored multipliers the pass must be the only one.
void clamp_to_bounds(const Pool& pool, const float* multipliers, const SweepArguments& a, Work& work) {
  const float h2 = a.h * a.h;
  for (int row = 0; row < pool.components; ++row) {
    const float before = multipliers == nullptr || a.first_pass ? 0 : multipliers[row * batch_width];
    const float low = work.bounds[3 * row] * h2, high = work.bounds[3 * row + 1] * h2;
    work.change[row] = clamp(before + work.change[row], low, high) - before;
  }
}

void evaluate(const ConstraintDefinition& type, Work& work) {
  StencilArrays<float>& arrays = work.arrays;
  if (type.evaluate_bounded != nullptr)
    type.evaluate_bounded(arrays.slots, arrays.rest, arrays.c, arrays.gradients, work.bounds);
  else
    type.evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
}

/// Solves L D L^T x = b in place: `m` is overwritten by its factors, `x` (first b) by the solution.
void solve(int rows, float (&m)[most_components][most_components], float (&x)[most_components]) {
  bool lost[most_components] = {};
  for (int i = 0; i < rows; ++i) {
    const float whole = m[i][i];
    for (int j = 0; j <= i; ++j) {
      float left = m[i][j];
      for (int k = 0; k < j; ++k) left = left - m[i][k] * m[k][k] * m[j][k];
      m[i][j] = i == j ? left : lost[j] ? 0 : left / max(m[j][j], smallest_denominator);
    }
    lost[i] = m[i][i] < least_pivot * whole;
    for (int j = 0; j < i; ++j) x[i] = x[i] - m[i][j] * x[j];
  }
  for (int i = 0; i < rows; ++i) x[i] = lost[i] ? 0 : x[i] / max(m[i][i], smallest_denominator);
  for (int i = rows; i-- > 0;)
    for (int j = i + 1; j < rows; ++j) x[i] = x[i] - m[j][i] * x[j];
}

/// For types of one row: increases the diagonal so that the correction changes C by at most `largest_change`.
void hold_to_trust(const ConstraintDefinition& type, const Pool& pool, Work& work) {
  if (!(type.largest_change > 0) || pool.components != 1) return;
  const float mass = coupling(pool, work, 0, 0), numerator = work.change[0];
  work.matrix[0][0] = max(work.matrix[0][0], max(numerator, -numerator) * mass * (1 / type.largest_change));
}

void apply(const CompiledObject& object, const SweepArguments& a, const FrameArguments& f, const Pool& pool,
           const std::int32_t* number, const Work& work) {
  for (int slot = 0; slot < pool.stencil; ++slot) {
    const SlotMass& mass = work.mass[slot];
    if (mass.is_frame) {
      Vec3f torque{};
      for (int row = 0; row < pool.components; ++row)
        torque += work.arrays.gradient(pool, row, slot) * work.change[row];
      const std::int32_t frame = number[slot] - object.particles;
      rotate_frame(mass.times(torque), f.orientations[frame], f.corrections[frame]);
      continue;
    }
    Record& d = a.displacements[number[slot]];
    for (int row = 0; row < pool.components; ++row) {
      const Vec3f move = work.arrays.gradient(pool, row, slot) * (mass.inverse_mass * work.change[row]);
      d = {d.x + move.x, d.y + move.y, d.z + move.z, 0};
    }
  }
}

}  // namespace

Yielding yielding_of(const ConstraintPlace& at, const SweepArguments& a) {
  const Law law = at.pool.law;
  const float softness = at.value(at.pool.fields);
  const float compliance = law == Law::pbd ? 0 : min(softness * a.inverse_h2, largest_compliance);
  const float damping =
      law == Law::damped ? min(softness * at.value(at.pool.fields + 1) * a.inverse_h, largest_compliance) : 0;
  return {compliance, damping};
}

void rotate_frame(const Vec3f& theta, Record& orientation, Record& corrections) {
  const Quatf now = joint_formulas::turned(quaternion(orientation), theta);
  orientation = {now.x, now.y, now.z, now.w};
  corrections = {corrections.x + theta.x, corrections.y + theta.y, corrections.z + theta.z, 0};
}

void project_segment(const CompiledObject& object, const Segment& segment, const SweepArguments& points,
                     const FrameArguments& frames) {
  if (segment.is_of_one_body) return project_tied_body(object, segment, points, frames);
  const Pool& pool = object.pools[segment.pool];
  const ConstraintDefinition& type = constraint_type(pool.type);
  float* all = points.multipliers != nullptr && pool.law != Law::pbd ? points.multipliers[segment.pool] : nullptr;
  const char* skipped = points.skipped != nullptr ? points.skipped[segment.pool] : nullptr;
  Work work;
  for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
    if (skipped != nullptr && skipped[at.batch * batch_width + at.lane] != 0) return;
    float* multipliers = all == nullptr ? nullptr : all + at.multiplier_place(0);
    load(object, points, frames, pool, number, work);
    work.arrays.load_rest(at);
    evaluate(type, work);
    if (type.acts_on_motion)
      assemble_motion(at, multipliers, points, work);
    else
      assemble(at, multipliers, points, work);
    hold_to_trust(type, pool, work);
    solve(pool.components, work.matrix, work.change);
    for (int row = 0; row < pool.components; ++row) work.change[row] = work.change[row] * points.relaxation;
    if (type.evaluate_bounded != nullptr) clamp_to_bounds(pool, multipliers, points, work);
    for (int row = 0; row < pool.components && multipliers != nullptr; ++row) {
      float& multiplier = multipliers[row * batch_width];
      multiplier = (points.first_pass ? 0.f : multiplier) + work.change[row];
    }
    apply(object, points, frames, pool, number, work);
  });
}

}  // namespace pliant
