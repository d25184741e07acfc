// The force of a viscous damper in a substep, alone and beside a spring.
//
// A mode of frequency omega with the damping time tau loses omega^2 tau / 2 of its amplitude per second. Let its force
// in a substep be that of a C(x) + b C(x0) + c C(x0 - h v0), a + b + c = 1. The roots of the recurrence have the
// product (1 + c (omega h)^2) / (1 + a (omega h)^2), so the mode loses (a - c) (omega h)^2 / 2 in a substep: a - c is
// the damping time in substeps. Implicit Euler alone (a = 1) damps as one substep does, and gamma = tau / h of XPBD,
// which makes a = 1 + gamma, as tau + h. So gamma is lessened by what the elastic force loses by itself.
#pragma once

#include "math/functions.h"
#include "math/scalar.h"

namespace pliant {

/// What is left of gamma = alpha beta / h for the viscous force, where the elastic force by itself damps as `lost`
/// substeps do: a - c above, 1 of implicit Euler. Never negative, so as stable as without damping. A time below that is
/// as long as `lost` substeps.
template <class R>
PLIANT_HD R viscous_share(const R& gamma, const R& lost = R(1.f)) {
  return max(gamma - lost, R(0.f));
}

/// The weight of the speed at the substep's end in the mean speed that a damper resists; that of the start has the
/// rest. `decay` is h c w, by which a damper c alone slows an inverse mass w. A damper alone then leaves exp(-decay)
/// of the speed, whatever the substep, and a steady force its terminal speed. In a mechanism, where the effective
/// inverse mass is smaller than that of the two bodies, the error is of second order in h. From 1/2 (midpoint) to 1
/// (implicit Euler).
inline double weight_of_end(double decay) {
  if (decay < 0.02) return 0.5 + decay / 12;
  if (decay > 40) return 1 - 1 / decay;
  return -1 / expm1(-decay) - 1 / decay;
}

/// What a viscous force weighs: the displacement in the substep, and that at the velocity of its start.
struct ViscousWeights {
  float motion = 0, coast = 0;
};

/// The weights of a damper beside a spring, of the second order in h: `share` is a viscous_share, and `mass` the
/// inverse mass along the row over the compliance over h^2, so that the damper alone slows it by share * mass.
inline ViscousWeights viscous_weights(float share, float mass) {
  if (!(share > 0)) return {};
  const auto end = static_cast<float>(weight_of_end(static_cast<double>(share) * static_cast<double>(mass)));
  return {share * end, share * (1 - end)};
}

/// A row that imposes a displacement in a substep, with what it yields by.
struct DampedRow {
  float compliance = 0;  ///< displacement over multiplier [1/kg]
  float target = 0;      ///< [m or rad]
};

/// The row of a damper: `compliance` is 1 / (h c), `inverse_mass` that along the row, `target` the imposed speed times
/// h, and `coast` the displacement along the row at the speed of the substep's start. Without compliance the target is
/// imposed.
inline DampedRow damped_row(float compliance, float inverse_mass, float target, float coast) {
  if (!(compliance > 0)) return {compliance, target};
  const auto end =
      static_cast<float>(weight_of_end(static_cast<double>(inverse_mass) / static_cast<double>(compliance)));
  return {compliance / end, (target - (1 - end) * coast) / end};
}

}  // namespace pliant
