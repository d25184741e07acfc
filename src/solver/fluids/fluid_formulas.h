// The formulas of a liquid's passes, for one float and for sixteen lanes. Macklin and Mueller 2013, with one kernel for
// density and gradient, and with multipliers and compliance of XPBD (Macklin, Mueller and Chentanez 2016).
#pragma once

#include "math/inverse_root.h"
#include "math/vector.h"
#include "math/wide.h"
#include "solver/fluids/fluid_law.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace fluid_formulas {

using pliant::inverse_root, pliant::max, pliant::min, pliant::select;  // of floats, which those of lanes hide

/// The squared distance of coincident particles [m^2].
inline constexpr float least_squared = 1e-12f;

/// Sums over the neighbours of a particle.
template <class R>
struct Sums {
  R cubes{0.f};                              ///< of q^3
  R fourths{0.f};                            ///< of q^4
  Vec3<R> gradient{R(0.f), R(0.f), R(0.f)};  ///< of q^2 times the direction from the neighbour
};

/// The kernel of a neighbour at -d: q = max(reach - r, 0), q^2 and q^2 / r.
template <class R>
struct Kernel {
  R q, square, factor;

  PLIANT_HD Kernel(const Vec3<R>& d, const R& reach) {
    const R r2 = max(d.x * d.x + d.y * d.y + d.z * d.z, R(least_squared));
    const R inverse = inverse_root(r2);
    q = max(reach - r2 * inverse, R(0.f));
    square = q * q;
    factor = square * inverse;
  }
};

/// Adds a neighbour at -d.
template <class R>
PLIANT_HD void add_neighbour(const Vec3<R>& d, const R& reach, Sums<R>& sums) {
  const Kernel<R> kernel(d, reach);
  sums.cubes += kernel.square * kernel.q;
  sums.fourths += kernel.square * kernel.square;
  sums.gradient = {sums.gradient.x + kernel.factor * d.x, sums.gradient.y + kernel.factor * d.y,
                   sums.gradient.z + kernel.factor * d.z};
}

/// A particle's density, and how far its multiplier changes.
template <class R>
struct Solved {
  R density, change;
};

/// `least` is added to the squared gradients. `multiplier` is what it is before, at most 0: a liquid pushes and does
/// not pull.
template <class R>
PLIANT_HD Solved<R> solve(const FluidLaw& law, float relaxation, float softness, const Sums<R>& sums, const R& wall,
                          const Vec3<R>& wall_gradient, const R& least, const R& multiplier) {
  const R scale(law.gradient_scale);
  const Vec3<R> gradient{wall_gradient.x - scale * sums.gradient.x, wall_gradient.y - scale * sums.gradient.y,
                         wall_gradient.z - scale * sums.gradient.z};
  const R density = R(law.own) + R(law.density_scale) * sums.cubes + wall;
  const R squared = gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z +
                    scale * scale * sums.fourths + least;
  const R error = density - R(1.f) + R(softness) * multiplier;
  const R change = -error / (squared / R(relaxation) + R(softness));
  return {density, min(multiplier + change, R(0.f)) - multiplier};
}

}  // namespace fluid_formulas
}  // namespace PLIANT_ISA
}  // namespace pliant
