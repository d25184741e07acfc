// Random floats and vectors for tests of the solver.
#pragma once

#include <random>

#include "math/vector.h"

namespace pliant::testing_support {

inline float uniform_float(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

inline Vec3f random_vector(std::mt19937& random, float range) {
  const float x = uniform_float(random, -range, range), y = uniform_float(random, -range, range);
  return {x, y, uniform_float(random, -range, range)};
}

}  // namespace pliant::testing_support
