// The overstretch of a distance constraint, written once for a float and for sixteen lanes.
#pragma once

#include "math/scalar.h"
#include "pliant/vec3.h"
#include "solver/project.h"

namespace pliant {

/// C / L of the distance between two points `across` from one another [-].
template <class R>
PLIANT_HD R overstretch(const Vec3<R>& across, const R& rest) {
  return (sqrt(length_squared(across)) - rest) / rest;
}

/// (C + explained) / L [-], with the sum of explained_by_force and explained_by_damping [m].
template <class R>
PLIANT_HD R overstretch(const Vec3<R>& across, const R& rest, const R& explained) {
  return (sqrt(length_squared(across)) - rest + explained) / rest;
}

/// alpha~ lambda, with `compliance` alpha [m/N]: minus the stretch that the elastic force explains [m].
template <class R>
PLIANT_HD R explained_by_force(const R& compliance, const R& multiplier, const R& inverse_h2) {
  return min(compliance * inverse_h2, R(largest_compliance)) * multiplier;
}

/// The same for the damping force: what damper.h leaves of alpha beta, times the speed along the constraint [m], with
/// `damping` beta [s].
template <class R>
PLIANT_HD R explained_by_damping(const Vec3<R>& across, const Vec3<R>& speed, const R& compliance, const R& damping,
                                 float inverse_h2) {
  return viscous_share(compliance * damping, R(1 / sqrt(inverse_h2))) * dot(across, speed) /
         max(sqrt(length_squared(across)), R(1e-20f));
}

/// The square of a length [m^2]: a shorter constraint has no overstretch above `above`, with whatever roundings.
template <class R>
PLIANT_HD R least_squared(const R& rest, const R& above, const R& explained) {
  const R slack = R(4e-6f);  // sixty-four roundings
  const R least =
      max(rest * (R(1.f) + above - slack * (R(1.f) + abs(above))) - explained - slack * abs(explained), R(0.f));
  return least * least;
}

/// The substeps that a distance constraint demands: in proportion to its strain, or to the angle that it turns by,
/// whichever are more.
template <class R>
PLIANT_HD R demand(const Vec3<R>& across, const Vec3<R>& speed, const R& rest, const R& by_stretch, const R& by_turn) {
  const R squared = max(length_squared(across), R(1e-30f)), along = dot(across, speed);
  const R across_squared = max(length_squared(speed) - along * along / squared, R(0.f));
  return max(by_stretch * overstretch(across, rest), by_turn * sqrt(across_squared / squared));
}

}  // namespace pliant
