// How stiff multigrid takes springs to be at most.
#pragma once

namespace pliant {

/// The mass of an object [kg], the largest side of its bounding box and the mean rest length of its springs [m].
struct SpringMeasures {
  double mass = 0, extent = 0, spacing = 0;
};

/// The limit of a spring's stiffness away from pins: each edge of a cross-section carries its share of the object's
/// weight, and stretches by about 0.1 % [N/m].
double spring_limit(const SpringMeasures& measures, double particles, double gravity);

}  // namespace pliant
