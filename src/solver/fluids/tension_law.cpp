#include "solver/fluids/tension_law.h"

#include <algorithm>

namespace pliant {

namespace {

constexpr double reach = 3, full = 0.95;  // reach over the spacing
/// The tension that the height of puddles shows, over that of particles that are spread evenly: those at a surface crowd, which lowers it.
constexpr double crowding = 0.85;
/// The square of the longest substep over sqrt(mass of a particle / surface tension). At 0.1 drops hardly oscillate, at 0.15 they burst.
constexpr float stable = 0.0036f;

/// Calls body(squared distance) for each point of a cubic lattice of spacing 1 within reach of one of its points, that one too.
template <class Body>
void for_lattice(const Body& body) {
  constexpr int most = 3;
  for (int x = -most; x <= most; ++x)
    for (int y = -most; y <= most; ++y)
      for (int z = -most; z <= most; ++z) body(x * x + y * y + z * z);
}

double count_of_lattice() {
  double sum = 0;
  for_lattice([&](int r2) {
    const double u = std::max(1 - r2 / (reach * reach), 0.0);
    sum += u * u;
  });
  return sum;
}

/// The share of the integral of (1 - r^2)^2 over the unit ball beyond a plane at distance t from its centre.
double beyond_plane(double t) {
  // The slab at z has pi (1 - z^2)^3 / 3; the whole is 32 pi / 105.
  const auto primitive = [](double z) {
    const double z2 = z * z, z3 = z2 * z;
    return z - z3 + 3 * z3 * z2 / 5 - z3 * z2 * z2 / 7;
  };
  return 35. / 32 * (primitive(1) - primitive(t));
}

/// The energy of a plane surface per area, of particles with energy (full - c)^2 / 2 and a volume of 1, with lengths over the spacing.
double energy_of_plane() {
  constexpr int steps = 1024;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double lack = std::max(full - 1 + beyond_plane((i + 0.5) / steps), 0.0);
    sum += lack * lack / 2;
  }
  return sum * reach / steps;
}

}  // namespace

TensionLaw tension_law(float spacing) {
  const double s = static_cast<double>(spacing), count = count_of_lattice();
  TensionLaw law;
  law.reach = static_cast<float>(reach * s);
  law.own = static_cast<float>(1 / count);
  law.count_scale = static_cast<float>(1 / count);
  law.full = static_cast<float>(full);
  law.energy = static_cast<float>(s * s / (energy_of_plane() * crowding));
  law.gradient_scale = static_cast<float>(4 / (count * reach * reach * s * s));
  law.stiffness = stable;
  return law;
}

}  // namespace pliant
