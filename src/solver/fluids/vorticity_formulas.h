// The formulas of vorticity confinement, which liquids and gases share, each for one particle.
#pragma once

#include "math/inverse_root.h"
#include "math/vector.h"
#include "solver/fluids/fluid_law.h"

namespace pliant::vorticity_formulas {

/// The kernel's gradient at d from a neighbour, over -d, times the volume of a particle at rest [1/m^2].
inline float gradient_factor(const FluidLaw& law, const Vec3f& d) {
  const float r2 = max(length_squared(d), 1e-12f), inverse = inverse_root(r2);
  const float q = max(law.reach - r2 * inverse, 0.f);
  return law.gradient_scale * (q * q) * inverse;
}

/// The acceleration for a coefficient of 1 m/s: N x omega (Macklin and Mueller 2013, eq. 16), with N the direction of
/// `slope`, the gradient of
/// |omega|.
inline Vec3f confinement(const FluidLaw& law, const Vec3f& slope, const Vec3f& vorticity, float vorticity_size) {
  constexpr float small =
      0.1f;  // where vorticity varies less than this over the kernel's reach, no direction is preferred
  const float size = length(slope) + small * vorticity_size / law.reach;
  return size > 0 ? cross(slope, vorticity) * (1 / size) : Vec3f{};
}

}  // namespace pliant::vorticity_formulas
