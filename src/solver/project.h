// The projection of one constraint, written once for one float and for sixteen lanes.
#pragma once

#include "constraints/traits.h"
#include "math/scalar.h"
#include "math/unroll.h"
#include "model/pool.h"
#include "solver/damper.h"
#include "solver/energy_law.h"
#include "solver/kernels.h"

namespace pliant {

/// Lower limit of denominators: a constraint between fixed particles divides by this and moves nothing.
inline constexpr float smallest_denominator = 1e-20f;
/// Upper limit of alpha / h^2, so that infinite compliance times a zero multiplier is zero.
inline constexpr float largest_compliance = 1e30f;

/// Displacement of the stencil along the gradients since the substep's start: grad C . (x - x_start).
template <class T, class R>
PLIANT_HD R motion_along(const Vec3<R> (&gradient)[slot_count<T>], const Vec3<R>* motion) {
  R sum = dot(gradient[0], motion[0]);
  PLIANT_UNROLL
  for (int slot = 1; slot < slot_count<T>; ++slot) sum = sum + dot(gradient[slot], motion[slot]);
  return sum;
}

/// The denominator of a projection: sum_i w_i |grad_i C|^2.
template <class T, class R>
PLIANT_HD R generalised_inverse_mass(const Vec3<R> (&gradient)[slot_count<T>], const R (&w)[slot_count<T>]) {
  R sum = has_unit_gradients<T> ? w[0] : w[0] * length_squared(gradient[0]);
  PLIANT_UNROLL
  for (int slot = 1; slot < slot_count<T>; ++slot) {
    sum = sum + (has_unit_gradients<T> ? w[slot] : w[slot] * length_squared(gradient[slot]));
  }
  return sum;
}

/// Limits the correction of constraint types that declare a `largest_change` of C, within which their linearisation is
/// valid: returns a larger denominator where necessary, otherwise `denominator` unchanged.
template <class T, class R>
PLIANT_HD R within_trust(const R& denominator, const R& numerator, const R& mass) {
  if constexpr (requires { T::largest_change; }) {
    return max(denominator, max(numerator, -numerator) * mass * R(1 / T::largest_change));
  } else {
    return denominator;
  }
}

/// The denominator of a solid's or a woven triangle's constraint in a sweep of one pass: its compliance is lowered by
/// the share `lead` of `rigid`, the denominator without compliance, and not below zero. Such a sweep treats neighbours
/// that come later as if they were at rest, so a static load moves each constraint as if its compliance were greater by
/// about half of `rigid` (docs/internals/solids.md, woven.md).
template <class R>
PLIANT_HD R led(const R& denominator, const R& rigid, const R& lead) {
  return max(denominator - lead * rigid, rigid);
}

/// The inputs of a projection besides positions: compliance, damping, multiplier.
template <class R>
struct ConstraintResponse {
  R softness;             ///< compliance alpha [m/N where C is a length], or PBD stiffness k' [-]
  R damping;              ///< damping coefficient beta
  R multiplier;           ///< lambda of this substep; updated by project
  bool is_kept = true;    ///< false: there is no multiplier, and what it would be is not asked
  bool is_damped = true;  ///< false: of Law::damped, but without damping
  R share = R(1.f);       ///< in general sweeps: share of dlambda that is added to the multiplier
};

/// Upper limit of a damping time over the substep in project_strain: more damps as much.
inline constexpr float most_damping = 1e9f;

/// Projects a damped constraint that measures a strain, in the first pass of a substep. The elastic and the viscous
/// stress act as one constraint along their sum, with g, a as in `project`, G = dC/dF, F' the change of F since the
/// substep's start and E' the change of the strain across the strain:
///   P = S G + 2 g F E',   S = C + g G . F',   |P|^2 = S^2 + 2 g^2 |E'|^2,   s = S^2 / |P|^2
///   dlambda = -|P| / ((g + s) sum w |P_i|^2 / |P|^2 + a) along P / |P|, with P_i the gradients of P at the corners
/// Only the share s along the gradient of C changes C, and is led. Where E' is zero this is the law of `project`, and
/// where S is zero dlambda = -g |F'| / (g sum w |P_i|^2 / |P|^2 + a). The multiplier gets the part along G.
template <class T, bool keeps_multiplier, bool general, class R>
PLIANT_HD void project_strain(const Vec3<R> (&x)[slot_count<T>], const R (&w)[slot_count<T>],
                              const typename T::template Params<R>& params, const Vec3<R> (&motion)[slot_count<T>],
                              ConstraintResponse<R>& response, const SweepArguments& a,
                              Vec3<R> (&correction)[slot_count<T>]) {
  const auto f = T::deformation(x, params), by = T::deformation(motion, params);
  auto gradient_of_f = f;
  const R c = T::evaluate_at(f, params, gradient_of_f);
  const auto across = T::change_across(f, by);
  const R along = dot(gradient_of_f.x, by.x) + dot(gradient_of_f.y, by.y) + dot(gradient_of_f.z, by.z);
  const R compliance = min(response.softness * R(a.inverse_h2), R(largest_compliance));
  const R gamma = viscous_share(min(response.softness * response.damping * R(a.inverse_h), R(most_damping)));
  const R stress = c + gamma * along, squares = stress * stress + R(2) * (gamma * gamma * across.squares());
  const R size = sqrt(min(max(squares, R(1e-30f)), R(1e36f))), unit = R(1) / size;
  Vec3<R> gradient[slot_count<T>];
  T::to_corners(gradient_of_f * (stress * unit) + f.times(across) * (R(2) * gamma * unit), params, gradient);
  const R mass = generalised_inverse_mass<T>(gradient, w);
  const R share = (stress * unit) * (stress * unit), rigid = mass * (gamma + share);
  const R led_part = R(a.lead) * (mass * share * (R(1) + gamma));
  R change = R(-1) / max(max(rigid + compliance - led_part, rigid), R(smallest_denominator));
  if constexpr (general) change = change * R(a.relaxation);
  if constexpr (keeps_multiplier)
    response.multiplier = response.multiplier + stress * (general ? change * response.share : change);
  const R step = size * change;
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot) correction[slot] = gradient[slot] * (w[slot] * step);
}

/// Adds to the corrections what damping takes from a strain that only changes its direction. Once in a substep, as it
/// keeps no multiplier.
template <class T, bool general, class R>
PLIANT_HD void damp_across(const Vec3<R> (&x)[slot_count<T>], const R (&w)[slot_count<T>],
                           const typename T::template Params<R>& params, const Vec3<R> (&motion)[slot_count<T>],
                           const ConstraintResponse<R>& response, const SweepArguments& a,
                           Vec3<R> (&correction)[slot_count<T>]) {
  if (!response.is_damped || !a.first_pass) return;
  Vec3<R> gradient[slot_count<T>];
  const R moved = T::strain_across(x, motion, params, gradient), mass = generalised_inverse_mass<T>(gradient, w);
  const R compliance = min(response.softness * R(a.inverse_h2), R(largest_compliance));
  const R gamma = viscous_share(min(response.softness * response.damping * R(a.inverse_h), R(largest_compliance)));
  R change = -(gamma * moved) / max(gamma * mass + compliance, R(smallest_denominator));
  if constexpr (general) change = change * R(a.relaxation);
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot)
    correction[slot] = correction[slot] + gradient[slot] * (w[slot] * change);
}

/// `project` where the constraint need not be split.
template <class T, Law law, bool keeps_multiplier, bool general, class R>
PLIANT_HD void project_whole(const Vec3<R> (&x)[slot_count<T>], const R (&w)[slot_count<T>],
                             const typename T::template Params<R>& params, const Vec3<R> (&motion)[slot_count<T>],
                             ConstraintResponse<R>& response, const SweepArguments& a,
                             Vec3<R> (&correction)[slot_count<T>], const Vec3<R>* coast) {
  if constexpr (law == Law::damped && measures_strain<T>) {
    if (coast == nullptr && a.first_pass)
      return project_strain<T, keeps_multiplier, general>(x, w, params, motion, response, a, correction);
  }
  Vec3<R> gradient[slot_count<T>];
  const R c = T::evaluate(x, params, gradient);
  const R mass = generalised_inverse_mass<T>(gradient, w);
  R change;
  if constexpr (law == Law::pbd) {
    const R numerator = -(response.softness * c);
    change = numerator / max(within_trust<T>(mass, numerator, mass), R(smallest_denominator));
  } else {
    const R compliance = min(response.softness * R(a.inverse_h2), R(largest_compliance));
    R numerator = -c, denominator = mass + compliance;
    if constexpr (keeps_multiplier) {
      if (response.is_kept) numerator = numerator - compliance * response.multiplier;
    }
    R lost = R(1.f);
    if (coast != nullptr) {  // known at compile time
      const auto mean = energy_law::shares_of(compliance, mass, R(energy_law::most_of_sweep));
      numerator =
          numerator + (mean.motion * motion_along<T>(gradient, motion) + mean.coast * motion_along<T>(gradient, coast));
      denominator = denominator - mean.motion * mass;
      lost = R(1.f) - mean.motion - mean.coast;
    }
    if constexpr (law == Law::damped) {
      const R gamma =
          viscous_share(min(response.softness * response.damping * R(a.inverse_h), R(largest_compliance)), lost);
      numerator = numerator - gamma * motion_along<T>(gradient, motion);
      denominator = denominator + gamma * mass;
    }
    if constexpr (is_led<T>) denominator = led(denominator, denominator - compliance, R(a.lead));
    change = numerator / max(within_trust<T>(denominator, numerator, mass), R(smallest_denominator));
  }
  if constexpr (general) change = change * R(a.relaxation);
  if constexpr (keeps_multiplier)
    response.multiplier = response.multiplier + (general ? change * response.share : change);
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot) correction[slot] = gradient[slot] * (w[slot] * change);
  if constexpr (law == Law::damped && measures_strain<T>) {
    if (coast != nullptr) damp_across<T, general>(x, w, params, motion, response, a, correction);
  }
}

/// The two parts C_i of a constraint of `can_split`, with their gradients.
template <class T, class R>
struct SplitConstraint {
  R c[2], whole;
  Vec3<R> gradient[2][slot_count<T>];
  R mass[3];  ///< sum w grad C_i . grad C_j: of both parts, and between them

  template <class F>
  PLIANT_HD SplitConstraint(const F& f, const typename T::template Params<R>& params, const R (&w)[slot_count<T>]) {
    F of_f[2];
    whole = T::split(f, c, of_f);
    for (int i = 0; i < 2; ++i) {
      T::to_corners(of_f[i], params, gradient[i]);
      mass[i] = generalised_inverse_mass<T>(gradient[i], w);
    }
    mass[2] = w[0] * dot(gradient[0][0], gradient[1][0]);
    for (int slot = 1; slot < slot_count<T>; ++slot)
      mass[2] = mass[2] + w[slot] * dot(gradient[0][slot], gradient[1][slot]);
  }

  /// Their share of the multiplier of C, whose gradient is the sum of C_i / C grad C_i.
  PLIANT_HD R share(int i) const { return c[i] / whole; }
};

/// Projects both parts of a constraint together, in the lanes that need it, with M of SplitConstraint::mass:
///   ((1 + g) M + a) dlambda = -C - a lambda - g grad C . (x - x_start),   a and g as in `project`
/// `multiplier` is lambda before. The other lanes keep their correction.
template <class T, Law law, bool keeps_multiplier, bool general, class R>
PLIANT_HD void project_parts(const Vec3<R> (&x)[slot_count<T>], const R (&w)[slot_count<T>],
                             const typename T::template Params<R>& params, const Vec3<R> (&motion)[slot_count<T>],
                             const R& multiplier, ConstraintResponse<R>& response, const SweepArguments& a,
                             Vec3<R> (&correction)[slot_count<T>]) {
  const auto f = T::deformation(x, params);
  const auto needed = T::needs_split(f);
  if (!any(needed)) return;
  const SplitConstraint<T, R> part(f, params, w);
  const R compliance = min(response.softness * R(a.inverse_h2), R(largest_compliance));
  R gamma(0.f), wanted[2] = {-part.c[0], -part.c[1]};
  if constexpr (law == Law::damped)
    gamma = viscous_share(min(response.softness * response.damping * R(a.inverse_h), R(most_damping)));
  for (int i = 0; i < 2; ++i) {
    if constexpr (law == Law::damped) wanted[i] = wanted[i] - gamma * motion_along<T>(part.gradient[i], motion);
    if (keeps_multiplier && response.is_kept) wanted[i] = wanted[i] - compliance * (multiplier * part.share(i));
  }
  const R least(smallest_denominator), factor = R(1.f) + gamma;
  const R first = max(factor * part.mass[0] + compliance, least), between = factor * part.mass[2] / first;
  const R second = factor * part.mass[1] + compliance;
  const R left = max(second - between * (factor * part.mass[2]), max(second * R(1e-6f), least));
  R change[2];
  change[1] = (wanted[1] - between * wanted[0]) / left;
  change[0] = wanted[0] / first - between * change[1];
  if constexpr (general)
    for (R& each : change) each = each * R(a.relaxation);
  if constexpr (keeps_multiplier) {
    const R square = part.whole * part.whole;  // of C: C_1^2 + C_2^2 is that and 4
    const R along = (change[0] * part.share(0) + change[1] * part.share(1)) * (square / (square + R(4.f)));
    response.multiplier = select(needed, multiplier + (general ? along * response.share : along), response.multiplier);
  }
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot) {
    const Vec3<R> both = (part.gradient[0][slot] * change[0] + part.gradient[1][slot] * change[1]) * w[slot];
    correction[slot] = {select(needed, both.x, correction[slot].x), select(needed, both.y, correction[slot].y),
                        select(needed, both.z, correction[slot].z)};
  }
}

/// Computes the corrections of one constraint, or of one in each lane.
///   PBD:   dlambda = -k' C / sum w |grad C|^2                                              (Mueller 2007, eq. 5 and 3.3)
///   XPBD:  dlambda = (-C - a lambda - g grad C . (x - x_start)) / ((1 + g) sum w |grad C|^2 + a)   (Macklin 2016, eq. 18,
///   26)
///          with a = alpha / h^2 and g = alpha beta / h, less what damper.h says; that of a solid or a woven triangle
///          in a sweep of one pass: see `led`
///          With Integrator::energy C is C^ of energy_law.h, and the 1 of (1 + g) is a.
///   Types that measure the length of a strain are projected by project_strain in the first pass. With Integrator::energy they are
///   damped across it apart:
///          dlambda = -g C' / (g sum w |grad C'|^2 + a), C' being strain_across of the motion since the substep's start
///   correction_i = w_i grad_i C dlambda
///   Where T::needs_split says so, a type of can_split is projected by project_parts.
///   In a general sweep dlambda is multiplied by the relaxation.
/// `coast` has the displacements in a substep at the velocities of its start, with Integrator::energy; else it is null.
template <class T, Law law, bool keeps_multiplier, bool general = false, class R>
PLIANT_HD void project(const Vec3<R> (&x)[slot_count<T>], const R (&w)[slot_count<T>],
                       const typename T::template Params<R>& params, const Vec3<R> (&motion)[slot_count<T>],
                       ConstraintResponse<R>& response, const SweepArguments& a, Vec3<R> (&correction)[slot_count<T>],
                       const Vec3<R>* coast = nullptr) {
  const R multiplier = response.multiplier;
  project_whole<T, law, keeps_multiplier, general>(x, w, params, motion, response, a, correction, coast);
  if constexpr (can_split<T> && law != Law::pbd)
    project_parts<T, law, keeps_multiplier, general>(x, w, params, motion, multiplier, response, a, correction);
}

}  // namespace pliant
