#include "math/closest_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pliant {
namespace {

double half_square(const Matrix3d& a, const Matrix3d& b) {
  double sum = 0;
  for (int i = 0; i < 9; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum / 2;
}

Matrix3d diagonal(double x, double y, double z) { return {{x, 0, 0, 0, y, 0, 0, 0, z}}; }

class ClosestVolume : public ::testing::Test {
 protected:
  std::mt19937 random{11};
  Matrix3d any(double size) {
    std::uniform_real_distribution<double> in_range(-size, size);
    Matrix3d m;
    for (double& element : m.elements) element = in_range(random);
    return m;
  }
  /// A random matrix of a positive determinant.
  Matrix3d of_determinant(double d) {
    Matrix3d m = any(2);
    const double is = determinant(m), scale = std::cbrt(d / is);
    for (double& element : m.elements) element *= scale;
    return m;
  }
};

TEST_F(ClosestVolume, HasTheDeterminantAndIsTheClosest) {
  for (const double d : {1., 0.19, 1e-4})
    for (const Matrix3d& f :
         {diagonal(1, 1, 1), diagonal(0.3, 1, 1), diagonal(1, 1, 0), diagonal(-1, 1, 1), diagonal(0, 0, 0),
          diagonal(0, 2, 0), diagonal(1.8, 1.9, 1.8), diagonal(3, 3, 3), diagonal(9, 2.1, 2), any(1), any(3)}) {
      const Matrix3d found = closest_of_determinant(f, d);
      EXPECT_NEAR(determinant(found) / d, 1, 1e-9);
      const double distance = half_square(f, found);
      for (int i = 0; i < 2000; ++i) EXPECT_LE(distance, half_square(f, of_determinant(d)) + 1e-12);
      for (int i = 0; i < 2000; ++i) {  // near the one found
        Matrix3d other = any(0.3);
        for (int k = 0; k < 9; ++k) other[k] += found[k];
        const double scale = std::cbrt(d / determinant(other));
        for (double& element : other.elements) element *= scale;
        EXPECT_LE(distance, half_square(f, other) + 1e-12);
      }
    }
}

TEST_F(ClosestVolume, KnownAnswers) {
  // At the right volume the matrix itself; the identity from zero; v1 = v2 and v3 of v (v - s) = mu from a flat one.
  for (int i = 0; i < 100; ++i) {
    const Matrix3d f = of_determinant(1);
    EXPECT_LT(half_square(f, closest_of_determinant(f, 1)), 1e-18);
  }
  EXPECT_LT(half_square(closest_of_determinant({}, 8), diagonal(2, 2, 2)), 1e-20);
  const Matrix3d thick = closest_of_determinant(diagonal(1, 1, 0), 1);
  EXPECT_NEAR(thick[0], thick[4], 1e-12);
  EXPECT_NEAR(thick[0] * (thick[0] - 1), thick[8] * thick[8], 1e-12);
  EXPECT_NEAR(thick[0] * thick[0] * std::abs(thick[8]), 1, 1e-12);
}

TEST_F(ClosestVolume, TheDifferenceIsTheGradientOfHalfTheSquaredDistance) {
  constexpr double step = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const Matrix3d f = any(1.5), difference = closest_of_determinant(f, 1);
    for (int k = 0; k < 9; ++k) {
      Matrix3d more = f, less = f;
      more[k] += step;
      less[k] -= step;
      const double slope =
          (half_square(more, closest_of_determinant(more, 1)) - half_square(less, closest_of_determinant(less, 1))) /
          (2 * step);
      EXPECT_NEAR(slope, f[k] - difference[k], 1e-6);
    }
  }
}

}  // namespace
}  // namespace pliant
