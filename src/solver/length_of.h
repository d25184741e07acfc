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

/// (C + alpha~ lambda) / L, with `compliance` alpha [m/N] and `multiplier` lambda [-].
template <class R>
PLIANT_HD R overstretch(const Vec3<R>& across, const R& rest, const R& compliance, const R& multiplier,
                        const R& inverse_h2) {
  const R explained = min(compliance * inverse_h2, R(largest_compliance)) * multiplier;
  return (sqrt(length_squared(across)) - rest + explained) / rest;
}

/// The substeps that a distance constraint demands: in proportion to its strain, or to the angle that it turns by, whichever
/// are more.
template <class R>
PLIANT_HD R demand(const Vec3<R>& across, const Vec3<R>& speed, const R& rest, const R& by_stretch, const R& by_turn) {
  const R squared = max(length_squared(across), R(1e-30f)), along = dot(across, speed);
  const R across_squared = max(length_squared(speed) - along * along / squared, R(0.f));
  return max(by_stretch * overstretch(across, rest), by_turn * sqrt(across_squared / squared));
}

}  // namespace pliant
