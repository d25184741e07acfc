// The density constraint of a liquid: its kernel, and what the kernel sums to in a liquid at rest.
#pragma once

#include "math/scalar.h"

namespace pliant {

/// What a pass over the particles of one liquid needs to know. W(r) = q^3 with q = reach - r, for density and gradient
/// alike, so that the gradient is that of the constraint (docs/internals/liquids.md).
struct FluidLaw {
  float reach = 0;           ///< of the kernel: twice the spacing [m]
  float own = 0;             ///< a particle's own share of the rest density [-]
  float density_scale = 0;   ///< from a sum of q^3 to a density over that at rest [1/m^3]
  float gradient_scale = 0;  ///< from a sum of q^2 to a gradient: three times that [1/m^3]
  /// Added to the squared gradients, so that a particle without neighbours has a multiplier [1/m^2]
  float least_sum = 0;
  float laplacian = 0;  ///< sum of the weights of neighbours in a Laplacian, in a lattice at rest [1/m^2]
  float passed_on = 0;  ///< what first derivatives by the kernel are in a lattice at rest, over what they should be [-]
  float wall_scale = 0;  ///< from the share of the kernel behind a wall to what a wall stands for [-]
};

/// The law of a liquid whose particles are `spacing` [m] apart at rest, on a cubic lattice.
FluidLaw fluid_law(float spacing);

/// The sum of squared gradients of a particle inside a liquid at rest, if all have the same mass [1/m^2].
double squared_gradients_at_rest(float spacing);

/// The compliance of a liquid whose density grows by p / (density c^2) under a pressure p [s^2/m^2]; 0 if c is 0. A
/// lattice of particles passes on 0.77 of the pressure that the multipliers stand for, so multipliers are larger than
/// p.
float fluid_compliance(float speed_of_sound);

/// The share of the kernel's integral that lies behind a plane at distance d from its centre, for 0 <= t = 1 - d /
/// reach <= 1: 0.5 for d = 0.
template <class R>
PLIANT_HD R share_behind_plane(const R& t) {
  const R t2 = t * t, t4 = t2 * t2;
  return t4 * t * (R(1.5f) - t);
}
/// Its derivative to d, times the reach; negative.
template <class R>
PLIANT_HD R slope_behind_plane(const R& t) {
  const R t2 = t * t, t4 = t2 * t2;
  return t4 * (R(6.f) * t - R(7.5f));
}

}  // namespace pliant
