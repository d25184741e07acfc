// Random numbers and positions for tests of collision.
#pragma once

#include <random>

#include "math/vector.h"

namespace pliant::testing_support {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A position whose coordinates are within `range` of 0; x is drawn first.
inline Vec3d random_place(Random& random, double range) {
  const double x = uniform(random, -range, range), y = uniform(random, -range, range),
               z = uniform(random, -range, range);
  return {x, y, z};
}

}  // namespace pliant::testing_support
