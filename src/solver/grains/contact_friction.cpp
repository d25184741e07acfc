#include <array>

#include "solver/grains/grain_solver.h"

namespace pliant {

namespace {

struct MeasuredFriction {
  float bulk, contact;
};

/// Spheres that do not turn lock: heaps of them are steeper than the friction of their contacts. Each is the
/// coefficient of contacts with which blocks of 3 120 spheres that a gate lets go come to rest at the slope of the
/// bulk, between 20 and 80 % of the height.
constexpr std::array<MeasuredFriction, 5> measured_frictions{
    {{0, 0}, {0.3f, 0.061f}, {0.5f, 0.153f}, {0.7f, 0.257f}, {1, 0.475f}}};

}  // namespace

float contact_friction(float of_bulk) {
  std::size_t i = 1;
  while (i + 1 < measured_frictions.size() && of_bulk > measured_frictions[i].bulk) ++i;
  const MeasuredFriction &below = measured_frictions[i - 1], &above = measured_frictions[i];
  return below.contact + (of_bulk - below.bulk) * ((above.contact - below.contact) / (above.bulk - below.bulk));
}

}  // namespace pliant
