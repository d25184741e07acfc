// Tests double-double arithmetic: results multiplied back, and digits that a double cannot represent.
#include "geometry/double_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pliant {
namespace {

double size_of(const DoubleDouble& a) { return std::fabs(static_cast<double>(a)); }

TEST(DoubleDouble, KeepsWhatDoubleLoses) {
  const DoubleDouble one(1), tiny(1e-25);
  EXPECT_EQ(static_cast<double>((one + tiny) - one), 1e-25);
  EXPECT_TRUE(one + tiny > one && one - tiny < one && one >= one && one <= one && !(one < one));
  const DoubleDouble third = one / DoubleDouble(3);
  EXPECT_LT(size_of(third * DoubleDouble(3) - one), 1e-31);
  EXPECT_EQ(abs(one - (one + tiny)).high, 1e-25);
  EXPECT_EQ(sqrt(DoubleDouble(0)).high, 0);
}

TEST(DoubleDouble, InvertsProductsQuotientsAndRoots) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-10, 10);
  for (int i = 0; i < 10000; ++i) {
    const DoubleDouble a = DoubleDouble(uniform(random)) + DoubleDouble(uniform(random) * 1e-17);
    const DoubleDouble b = DoubleDouble(uniform(random)) + DoubleDouble(uniform(random) * 1e-17);
    ASSERT_LE(size_of(a / b * b - a), 1e-30 * size_of(a));
    ASSERT_LE(size_of((a + b) - b - a), 1e-30 * (size_of(a) + size_of(b)));
    const DoubleDouble square = a * a;
    ASSERT_LE(size_of(sqrt(square) - abs(a)), 1e-30 * size_of(a));
    ASSERT_LE(size_of((a + b) * (a - b) - (square - b * b)), 1e-29 * (size_of(square) + size_of(b * b)));
  }
}

}  // namespace
}  // namespace pliant
