#include "model/cohesion.h"

#include <algorithm>
#include <cmath>

#include "model/object_sets.h"

namespace pliant {

namespace {

/// How far a contact stretches in a substep of 1 s before it parts, over the diameter: pull h^2 (2 / mass) / stiffness
/// [1/s^2].
double stretch_at_parting(const Grains& grains) {
  constexpr double sphere = 0.52359877559829887;  // pi / 6: volume over the cube of the diameter
  const double diameter = 2 * static_cast<double>(grains.radius);
  const double mass = sphere * static_cast<double>(grains.density) * diameter * diameter * diameter;
  const double pull = static_cast<double>(pull_of_contact(2 * grains.radius, grains.cohesion));
  return pull * 2 / (mass * static_cast<double>(stiffness_of_grains) * diameter);
}

}  // namespace

int substeps_of_cohesion(const Object& object, double frame_time) {
  constexpr double stretch = 0.03;
  if (!object.grains || !(object.grains->cohesion > 0)) return 1;
  const double h = std::sqrt(stretch / stretch_at_parting(*object.grains));
  return std::clamp(static_cast<int>(std::ceil(std::min(frame_time / h, 1e4))), 1, 1000);
}

double acting_cohesion(const Object& object, double frame_time, int substeps) {
  if (!object.grains || !(object.grains->cohesion > 0)) return 1;
  const double h = frame_time / substeps;
  return std::min(1.0, static_cast<double>(longest_bond) / (stretch_at_parting(*object.grains) * h * h));
}

}  // namespace pliant
