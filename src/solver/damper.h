// The force of a viscous damper in a substep.
#pragma once

#include "math/functions.h"

namespace pliant {

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
