// What the tests of geometry share.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <type_traits>

#include "math/vector.h"

namespace pliant::testing_support {

/// A random point in a cube of half edge `range` about the origin.
template <class R = double>
Vec3<R> random_point(std::mt19937_64& random, double range = 1) {
  std::uniform_real_distribution<double> uniform(-range, range);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return convert<R>(Vec3d{x, y, z});
}

template <class R>
void expect_near(const Vec3<R>& a, const std::type_identity_t<Vec3<R>>& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace pliant::testing_support
