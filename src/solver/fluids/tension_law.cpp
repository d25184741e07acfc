#include "solver/fluids/tension_law.h"

#include <algorithm>
#include <array>

#include "math/functions.h"

namespace pliant {

namespace {

constexpr double reach_over_spacing = 3, full_sum = 0.95;
/// The tension that the height of puddles shows, over that of particles that are spread evenly: those at a surface
/// crowd, which lowers it.
constexpr double crowding = 0.85;
/// The square of the longest substep over sqrt(mass of a particle / surface tension). At 0.1 drops hardly oscillate, at
/// 0.15 they burst.
constexpr float stable = 0.0036f;

/// Calls body(squared distance) for each point of a cubic lattice of spacing 1 within reach of one of its points, that
/// one too.
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
    const double u = std::max(1 - r2 / (reach_over_spacing * reach_over_spacing), 0.0);
    sum += u * u;
  });
  return sum;
}

/// The energy of a plane surface per area, of particles with energy (full_sum - c)^2 / 2 and a volume of 1, with
/// lengths over the spacing.
double energy_of_plane() {
  constexpr int steps = 1024;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double lack = std::max(full_sum - 1 + share_beyond_plane((i + 0.5) / steps), 0.0);
    sum += lack * lack / 2;
  }
  return sum * reach_over_spacing / steps;
}

/// Sum of W over the layers of a lattice at a wall, of which the first is half a spacing from it.
double shares_of_layers() {
  constexpr int layers = 3;
  double sum = 0;
  for (int layer = 0; layer < layers; ++layer) sum += share_beyond_plane((layer + 0.5) / reach_over_spacing);
  return sum;
}

struct Adhesion {
  double cosine, strength;
};

/// Particles crowd at walls and in the edge of a drop, so no sum over a lattice has the right energy. Each is the
/// strength with which drops of 1 200 particles without viscosity or gravity, that start as half balls or flatter at
/// the larger angles, come to rest at the angle.
constexpr std::array<Adhesion, 11> measured_adhesions{{{-1, 0},
                                                       {-0.95, 0.1},
                                                       {-0.78, 0.15},
                                                       {-0.62, 0.2},
                                                       {-0.33, 0.3},
                                                       {0, 0.4},
                                                       {0.14, 0.5},
                                                       {0.4, 0.7},
                                                       {0.53, 0.8},
                                                       {0.67, 0.9},
                                                       {1, 1}}};

double strength_of_adhesion(double cosine) {
  std::size_t i = 1;
  while (i + 1 < measured_adhesions.size() && cosine > measured_adhesions[i].cosine) ++i;
  const Adhesion &below = measured_adhesions[i - 1], &above = measured_adhesions[i];
  return below.strength + (cosine - below.cosine) * (above.strength - below.strength) / (above.cosine - below.cosine);
}

}  // namespace

double share_beyond_plane(double t) {
  // The slab at z has pi (1 - z^2)^3 / 3; the whole is 32 pi / 105.
  const auto primitive = [](double z) {
    const double z2 = z * z, z3 = z2 * z;
    return z - z3 + 3 * z3 * z2 / 5 - z3 * z2 * z2 / 7;
  };
  return 35. / 32 * (primitive(1) - primitive(t));
}

double slope_beyond_plane(double t) {
  const double rest = 1 - t * t;
  return -35. / 32 * rest * rest * rest;
}

WettingLaw wetting_law(float spacing, float contact_angle) {
  const double s = static_cast<double>(spacing);
  const double strength = strength_of_adhesion(sine_cosine_of_degrees(static_cast<double>(contact_angle)).cosine);
  return {static_cast<float>(strength), static_cast<float>(strength * s * s / shares_of_layers())};
}

TensionLaw tension_law(float spacing) {
  const double s = static_cast<double>(spacing), count = count_of_lattice();
  TensionLaw law;
  law.reach = static_cast<float>(reach_over_spacing * s);
  law.own = static_cast<float>(1 / count);
  law.count_scale = static_cast<float>(1 / count);
  law.full = static_cast<float>(full_sum);
  law.energy = static_cast<float>(s * s / (energy_of_plane() * crowding));
  law.gradient_scale = static_cast<float>(4 / (count * reach_over_spacing * reach_over_spacing * s * s));
  law.stiffness = stable;
  return law;
}

}  // namespace pliant
