// Compares the engine's own functions with the C library in higher precision, densely and at the ends of the number
// range.
//
// The bounds are those in functions.h. Errors are in units in the last place (ulp) of the true value.
#include "math/functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <random>

namespace pliant {
namespace {

constexpr float kFloatMax = std::numeric_limits<float>::max();
constexpr float kFloatMin = std::numeric_limits<float>::min();
constexpr float kFloatLeast = std::numeric_limits<float>::denorm_min();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// |value - truth| in units in the last place of `truth`, in the type of `value`.
template <class R>
double ulps(R value, long double truth) {
  if (std::isnan(value)) return kInfinity;
  const R near = std::fabs(static_cast<R>(truth));
  const R ulp = std::nextafter(near, std::numeric_limits<R>::infinity()) - near;
  return static_cast<double>(std::fabs(static_cast<long double>(value) - truth) / static_cast<long double>(ulp));
}

/// The largest error of a function, and the argument that has it.
struct Worst {
  double error = 0;
  long double at = 0, other = 0;
  void see(double e, long double x, long double y = 0) {
    if (!(e <= error)) error = e, at = x, other = y;
  }
};
std::ostream& operator<<(std::ostream& out, const Worst& w) {
  return out << w.error << " ulp at " << static_cast<double>(w.at) << ", " << static_cast<double>(w.other);
}

/// A finite number of any magnitude, from random bits.
template <class R, class Bits>
R any_finite(std::mt19937_64& random) {
  for (;;) {
    const R value = bits_as<R>(static_cast<Bits>(random()));
    if (std::isfinite(value)) return value;
  }
}

template <class R>
void see_atan2(Worst& worst, R y, R x) {
  const long double truth =
      x < 0 && y == 0 ? std::acos(-1.0L) : std::atan2(static_cast<long double>(y), static_cast<long double>(x));
  worst.see(ulps(atan2(y, x), truth), y, x);
}

TEST(Atan2, FloatIsWithinFourUlpAroundTheCircle) {
  Worst worst;
  for (const double radius : {1e-44, 1e-38, 1e-20, 1e-3, 1.0, 3.0, 1e20, 1.6e38}) {
    for (int i = 0; i < 100000; ++i) {
      const double angle = 6.283185307179586 * i / 100000 - 3.14;
      see_atan2(worst, static_cast<float>(radius * std::sin(angle)), static_cast<float>(radius * std::cos(angle)));
    }
  }
  EXPECT_LE(worst.error, 4) << worst;
}

TEST(Atan2, FloatIsWithinFourUlpOnRandomBits) {
  Worst worst;
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000000; ++i) {
    const float y = any_finite<float, std::uint32_t>(random), x = any_finite<float, std::uint32_t>(random);
    if (std::fabs(x) <= kFloatMax / 2 && std::fabs(y) <= kFloatMax / 2) see_atan2(worst, y, x);
  }
  EXPECT_LE(worst.error, 4) << worst;
}

TEST(Atan2, DoubleIsWithinThreeUlp) {
  Worst worst;
  std::mt19937_64 random(2);
  for (int i = 0; i < 200000; ++i) {
    const double angle = 6.283185307179586 * i / 200000 - 3.14;
    see_atan2(worst, std::sin(angle), std::cos(angle));
    const double y = any_finite<double, std::uint64_t>(random), x = any_finite<double, std::uint64_t>(random);
    if (std::fabs(x) <= 8e307 && std::fabs(y) <= 8e307) see_atan2(worst, y, x);
  }
  EXPECT_LE(worst.error, 3) << worst;
}

TEST(Atan2, KnowsTheAxesAndTheOrigin) {
  const float pi = 3.14159265f;
  EXPECT_EQ(atan2(0.f, 0.f), 0.f);
  EXPECT_EQ(atan2(-0.f, 0.f), 0.f);
  EXPECT_EQ(atan2(0.f, 1.f), 0.f);
  EXPECT_EQ(atan2(0.f, kFloatLeast), 0.f);
  EXPECT_EQ(atan2(1.f, 0.f), pi / 2);
  EXPECT_EQ(atan2(-1.f, 0.f), -pi / 2);
  EXPECT_EQ(atan2(kFloatLeast, 0.f), pi / 2);
  EXPECT_EQ(atan2(0.f, -1.f), pi);
  EXPECT_EQ(atan2(-0.f, -1.f), pi);
  EXPECT_EQ(atan2(1.f, 1.f), pi / 4);
  EXPECT_EQ(atan2(-1.f, 1.f), -pi / 4);
  EXPECT_EQ(atan2(kFloatLeast, kFloatMax), 0.f);
}

TEST(Atan2, EveryPairOfExtremesIsFiniteWithTheRightSigns) {
  Worst worst;
  for (const float y : {0.f, kFloatLeast, 3 * kFloatLeast, kFloatMin, 1e-20f, 1.f, 1e20f, kFloatMax / 2, kFloatMax}) {
    for (const float x : {0.f, kFloatLeast, 2 * kFloatLeast, kFloatMin, 1e-20f, 1.f, 1e20f, kFloatMax / 2, kFloatMax}) {
      for (const float sx : {-1.f, 1.f}) {
        const float angle = atan2(y, sx * x), mirrored = atan2(-y, sx * x);
        ASSERT_TRUE(std::isfinite(angle)) << y << " " << sx * x;
        EXPECT_NEAR(angle, sx * x < 0 && y == 0 ? 3.14159265 : std::atan2(static_cast<double>(y), sx * x + 0.0), 0.33)
            << y << " " << x;
        if (y > 0) {
          EXPECT_EQ(mirrored, -angle);
        }
        if (std::fabs(x) <= kFloatMax / 2 && y <= kFloatMax / 2) see_atan2(worst, y, sx * x + 0.f);
      }
    }
  }
  EXPECT_LE(worst.error, 4) << worst;
}

TEST(Atan2, HasNoBiggerJumpsThanItsErrorBetweenNeighbours) {
  // The angle of a nearly flat hinge must increase with the fold, or a bending constraint would push the wrong way.
  float before = atan2(-1e-3f, 1.f);
  for (float y = -1e-3f; y < 1e-3f; y += 1e-7f) {
    const float angle = atan2(y, 1.f);
    ASSERT_GE(angle, before) << y;
    before = angle;
  }
}

TEST(Atan2, LetsNanThrough) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float other : {-2.f, 0.f, 1.f, kFloatMax, nan}) {
    EXPECT_TRUE(std::isnan(atan2(nan, other))) << other;
    EXPECT_TRUE(std::isnan(atan2(other, nan))) << other;
  }
}

TEST(Acos, IsWithinFourUlpFromEndToEnd) {
  Worst single, twice;
  for (int i = -200000; i <= 200000; ++i) {
    const double x = i / 200000.0;
    single.see(ulps(acos(static_cast<float>(x)), std::acos(static_cast<long double>(static_cast<float>(x)))), x);
    twice.see(ulps(acos(x), std::acos(static_cast<long double>(x))), x);
  }
  for (float x = 1; x > 0.999f; x = std::nextafter(x, 0.f)) {  // where a naive formula loses digits
    single.see(ulps(acos(x), std::acos(static_cast<long double>(x))), x);
    single.see(ulps(acos(-x), std::acos(static_cast<long double>(-x))), -x);
  }
  EXPECT_LE(single.error, 4) << single;
  EXPECT_LE(twice.error, 4) << twice;
}

TEST(Acos, HoldsItsArgumentInRangeAndLetsNanThrough) {
  EXPECT_EQ(acos(1.f), 0.f);
  EXPECT_EQ(acos(1.0000001f), 0.f);
  EXPECT_EQ(acos(kFloatMax), 0.f);
  EXPECT_EQ(acos(-1.f), 3.14159265f);
  EXPECT_EQ(acos(-1.0000001f), 3.14159265f);
  EXPECT_EQ(acos(-kFloatMax), 3.14159265f);
  EXPECT_EQ(acos(0.f), 1.57079633f);
  EXPECT_TRUE(std::isnan(acos(std::numeric_limits<float>::quiet_NaN())));
}

TEST(SineCosine, AreWithinThreeUlpUpToAMillion) {
  Worst worst;
  std::mt19937_64 random(3);
  for (const double range : {1e-300, 1e-8, 0.8, 7.0, 1e3, 1.6e6}) {
    for (int i = 0; i < 100000; ++i) {
      const double x = range * std::uniform_real_distribution<double>(-1, 1)(random);
      worst.see(ulps(sin(x), std::sin(static_cast<long double>(x))), x);
      worst.see(ulps(cos(x), std::cos(static_cast<long double>(x))), x);
    }
  }
  for (int k = -1000; k <= 1000; ++k) {  // near the zeros, where the reduction must not cancel
    const double x = k * 1.5707963267948966;
    worst.see(ulps(sin(x), std::sin(static_cast<long double>(x))), x);
    worst.see(ulps(cos(x), std::cos(static_cast<long double>(x))), x);
  }
  EXPECT_LE(worst.error, 3) << worst;
}

TEST(SineCosine, StayInRangeForEveryFiniteNumber) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 200000; ++i) {
    const double x = any_finite<double, std::uint64_t>(random);
    ASSERT_LE(std::fabs(sin(x)), 1) << x;
    ASSERT_LE(std::fabs(cos(x)), 1) << x;
    if (std::fabs(x) > 1.6e6 && std::fabs(x) < 1e14) {
      ASSERT_NEAR(sin(x), static_cast<double>(std::sin(static_cast<long double>(x))), std::fabs(x) * 0x1p-51) << x;
    }
  }
  EXPECT_EQ(sin(0.f), 0.f);
  EXPECT_EQ(cos(0.f), 1.f);
  EXPECT_EQ(sin(1.57079633f), 1.f);
  for (const double x : {kInfinity, -kInfinity, std::nan("")}) {
    EXPECT_TRUE(std::isnan(sin(x)));
    EXPECT_TRUE(std::isnan(cos(x)));
  }
}

TEST(SineCosine, OfDegreesAreExactAtRightAngles) {
  for (int turns = -3; turns <= 3; ++turns) {
    const double whole = 360.0 * turns;
    const double expected[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int quarter = 0; quarter < 4; ++quarter) {
      const SineCosine of = sine_cosine_of_degrees(whole + 90 * quarter);
      EXPECT_EQ(of.sine, expected[quarter][0]);
      EXPECT_EQ(of.cosine, expected[quarter][1]);
    }
  }
  for (double degrees = -1000; degrees < 1000; degrees += 0.37) {
    const long double x = static_cast<long double>(degrees) * std::acos(-1.0L) / 180;
    EXPECT_NEAR(sine_cosine_of_degrees(degrees).sine, static_cast<double>(std::sin(x)), 3e-16) << degrees;
    EXPECT_NEAR(sine_cosine_of_degrees(degrees).cosine, static_cast<double>(std::cos(x)), 3e-16) << degrees;
  }
}

TEST(Exp, IsWithinTwoUlp) {
  Worst worst, shifted;
  for (int i = -200000; i <= 200000; ++i) {
    for (const double x : {i * 0.0035, i * 1e-5, i * 1e-9}) {
      worst.see(ulps(exp(x), std::exp(static_cast<long double>(x))), x);
      shifted.see(ulps(expm1(x), std::expm1(static_cast<long double>(x))), x);
    }
  }
  EXPECT_LE(worst.error, 2) << worst;
  EXPECT_LE(shifted.error, 4) << shifted;
}

TEST(Exp, KnowsItsEnds) {
  EXPECT_EQ(exp(0.0), 1);
  EXPECT_EQ(exp(1.f), 2.7182818f);
  EXPECT_EQ(exp(-kInfinity), 0);
  EXPECT_EQ(exp(-1e300), 0);
  EXPECT_EQ(exp(1e300), kInfinity);
  EXPECT_EQ(exp(kInfinity), kInfinity);
  EXPECT_EQ(exp(-745.0), 4.9406564584124654e-324);
  EXPECT_LT(exp(709.7), kInfinity);
  EXPECT_EQ(exp(710.0), kInfinity);
  EXPECT_TRUE(std::isnan(exp(std::nan(""))));
  EXPECT_EQ(expm1(0.0), 0);
  EXPECT_EQ(expm1(-1e9), -1);
}

TEST(Log, IsWithinTwoUlp) {
  Worst worst, shifted;
  std::mt19937_64 random(5);
  for (int i = 0; i < 300000; ++i) {
    const double any = std::fabs(any_finite<double, std::uint64_t>(random));
    for (const double x : {any, 1 + (i - 150000) * 1e-6, 0.5 + i * 1e-5}) {
      if (x > 0) worst.see(ulps(log(x), std::log(static_cast<long double>(x))), x);
    }
    for (const double x : {(i - 150000) * 6e-6, (i - 150000) * 1e-12}) {
      shifted.see(ulps(log1p(x), std::log1p(static_cast<long double>(x))), x);
    }
  }
  EXPECT_LE(worst.error, 2) << worst;
  EXPECT_LE(shifted.error, 4) << shifted;
}

TEST(Log, KnowsItsEnds) {
  EXPECT_EQ(log(1.0), 0);
  EXPECT_EQ(log(2.718281828f), 0.99999994f);
  EXPECT_EQ(log(0.0), -kInfinity);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_TRUE(std::isnan(log(std::nan(""))));
  EXPECT_EQ(ulps(log(4.9406564584124654e-324), std::log(4.9406564584124654e-324L)) <= 2, true);
}

TEST(Pow, SharesAStiffnessOut) {
  for (const double k : {0.0, 1e-7, 0.001, 0.3, 0.5, 0.9, 0.999999, 1.0}) {
    for (const int n : {1, 2, 3, 10, 100, 10000, 1000000}) {
      const double power = pow(1 - k, 1.0 / n);
      EXPECT_NEAR(power, static_cast<double>(std::pow(1 - static_cast<long double>(k), 1.0L / n)), 1e-12)
          << k << " " << n;
      double product = 1, factor = power;  // n factors by squaring: the definition itself
      for (int left = n; left > 0; left /= 2, factor *= factor) {
        if (left % 2 == 1) product *= factor;
      }
      EXPECT_NEAR(product, 1 - k, 1e-9) << k << " " << n;
      const double share = -expm1(log1p(-k) / n);
      const double truth = static_cast<double>(-std::expm1(std::log1p(-static_cast<long double>(k)) / n));
      EXPECT_NEAR(share, truth, 1e-14 * truth) << k << " " << n;
    }
  }
}

TEST(Pow, KnowsItsEnds) {
  EXPECT_EQ(pow(0.0, 0.5), 0);
  EXPECT_EQ(pow(0.0, 0.0), 1);
  EXPECT_EQ(pow(1.0, 123.0), 1);
  EXPECT_NEAR(pow(2.0, 10.0), 1024, 1e-11);
  EXPECT_TRUE(std::isnan(pow(-1.0, 0.5)));
}

/// A finite number of any magnitude, from bits that are random but the same on every machine.
template <class R, class Bits>
R next_finite(std::uint64_t& state) {
  for (;;) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const R value = bits_as<R>(static_cast<Bits>((state >> 11) ^ (state << 40)));
    if (std::isfinite(value)) return value;
  }
}

TEST(Functions, GiveTheSameBitsOnEveryMachine) {
  // A digest of a million results, which must be the same for any compiler, optimisation level and machine.
  std::uint64_t state = 1, digest = 14695981039346656037u;
  const auto add = [&digest](auto value) {
    const double wide = std::isnan(value) ? 0 : static_cast<double>(value);
    digest = (digest ^ bits_as<std::uint64_t>(wide)) * 1099511628211u;
  };
  for (int i = 0; i < 100000; ++i) {
    const float y = next_finite<float, std::uint32_t>(state), x = next_finite<float, std::uint32_t>(state);
    const double u = next_finite<double, std::uint64_t>(state), v = next_finite<double, std::uint64_t>(state);
    const float cosine = static_cast<float>(i - 50000) / 50000;
    add(atan2(y, x)), add(acos(cosine)), add(atan2(u, v)), add(sin(y)), add(cos(x));
    add(exp(700.0 * static_cast<double>(cosine))), add(log(u)), add(pow(static_cast<double>(i) / 100000, 0.1));
    add(expm1(static_cast<double>(cosine))), add(log1p(static_cast<double>(cosine)));
  }
  EXPECT_EQ(digest, 0x10d6f3d813891c97u) << std::hex << digest;
}

TEST(Scalar, MinAndMaxTakeTheSecondWhereUnordered) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(min(nan, 1.f), 1.f);
  EXPECT_TRUE(std::isnan(min(1.f, nan)));
  EXPECT_EQ(max(nan, 1.f), 1.f);
  EXPECT_TRUE(std::isnan(max(1.f, nan)));
  EXPECT_TRUE(std::signbit(min(0.f, -0.f)));
  EXPECT_FALSE(std::signbit(min(-0.f, 0.f)));
  EXPECT_EQ(clamp(5.f, -1.f, 1.f), 1.f);
  EXPECT_EQ(clamp(-5.0, -1.0, 1.0), -1.0);
}

}  // namespace
}  // namespace pliant
