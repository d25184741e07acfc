#include "solver/fluids/fluid_law.h"

#include "math/functions.h"

namespace pliant {

namespace {

/// Sums over the points of a cubic lattice of spacing 1 around one of them, with a kernel of reach 2.
struct Lattice {
  double cubes = 0;         ///< of q^3, with the point itself
  double fourths = 0;       ///< of q^4, without it
  double moments = 0;       ///< of q^2 r
  double steepness = 0;     ///< of q^2 / r, without it
  double cubes_beyond = 0;  ///< of q^3 behind a plane at half a spacing
};

Lattice lattice() {
  Lattice sums;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x) {
        const double r = sqrt(static_cast<double>(x * x + y * y + z * z)), q = 2 - r;
        if (!(q > 0)) continue;
        sums.cubes += q * q * q;
        sums.moments += q * q * r;
        if (x < 0) sums.cubes_beyond += q * q * q;
        if (x != 0 || y != 0 || z != 0) {
          sums.fourths += q * q * q * q;
          sums.steepness += q * q / r;
        }
      }
  return sums;
}

}  // namespace

double squared_gradients_at_rest(float spacing) {
  const Lattice sums = lattice();
  const double s = static_cast<double>(spacing);
  return 9 * sums.fourths / (sums.cubes * sums.cubes * s * s);
}

float fluid_compliance(float speed_of_sound) {
  if (!(speed_of_sound > 0)) return 0;
  const Lattice sums = lattice();
  const double c = static_cast<double>(speed_of_sound),
               passed_on = sums.moments / sums.cubes;  // 3 / S times a third: along an axis
  return static_cast<float>(passed_on / (c * c));
}

FluidLaw fluid_law(float spacing) {
  constexpr double share_of_least = 0.05;  // 0.01 to 0.05 give the same motion, 0.3 softens
  const Lattice sums = lattice();
  const double s = static_cast<double>(spacing), cubes = sums.cubes * s * s * s;
  FluidLaw law;
  law.reach = 2 * spacing;
  law.own = static_cast<float>(8 / sums.cubes);
  law.density_scale = static_cast<float>(1 / cubes);
  law.gradient_scale = static_cast<float>(3 / cubes);
  law.least_sum = static_cast<float>(share_of_least * squared_gradients_at_rest(spacing));
  law.passed_on = static_cast<float>(sums.moments / sums.cubes);
  law.laplacian = static_cast<float>(6 * sums.steepness / sums.moments / (s * s));
  law.wall_scale = static_cast<float>(sums.cubes_beyond / sums.cubes / share_behind_plane(0.75));
  return law;
}

}  // namespace pliant
