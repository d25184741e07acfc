// Trigonometric functions and their inverses, exponentials and logarithms with the same bits on every machine.
//
// Each libm rounds these differently, and one differing bit in a hinge angle changes the whole
// drape. Here they use only additions, multiplications, divisions and square roots, which IEEE 754
// rounds correctly. Functions of the sweeps (atan2, acos) are branch-free templates for float,
// double and Wide, with Estrin's scheme, because wide batches are latency-bound. Functions called
// rarely (sin, cos, exp, log, pow) compute in double; their float form rounds the result once.
//
// Tests verify every error bound given here.
#pragma once

#include "math/scalar.h"

namespace pliant {

/// Converts `value` to R.
template <class R>
PLIANT_HD R constant(double value) {
  return R(static_cast<float>(value));
}
template <>
PLIANT_HD double constant<double>(double value) {
  return value;
}

namespace detail {

/// (atan(t) / t - 1) / t^2 as a minimax polynomial in z = t^2 on [0, 1/4];
/// relative error of atan(t) 5.3e-9 (float) and 2.1e-19 (double) before rounding.
template <class R>
PLIANT_HD R atan_tail(const R& z) {
  const R z2 = z * z;
  const R low = constant<R>(-0.333332341855) + constant<R>(0.199942222105) * z;
  const R high = constant<R>(-0.141749621386) + constant<R>(0.101598121626) * z;
  return low + z2 * (high + constant<R>(-0.0513230735171) * z2);
}
template <>
PLIANT_HD double atan_tail<double>(const double& z) {
  const double z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
  const double a = (-0.33333333333333312124 + 0.19999999999993229267 * z) +
                   (-0.14285714284957702888 + 0.11111111068427944313 * z) * z2;
  const double b = (-0.090909076663602999878 + 0.076922770250935948945 * z) +
                   (-0.066662184035687293188 + 0.058777668412249776222 * z) * z2;
  const double c = (-0.052297963489608701412 + 0.045886655465777094216 * z) +
                   (-0.037100532944840022229 + 0.023630387747803390378 * z) * z2;
  return (a + b * z4) + (c + -0.0083509505947674623387 * z4) * z8;
}

/// The smallest positive number of R (subnormal). Added to a divisor, it avoids 0 / 0 and changes no other quotient.
template <class R>
PLIANT_HD R least_positive() {
  return R(1.4012984643e-45f);
}
template <>
PLIANT_HD double least_positive<double>() {
  return 4.9406564584124654e-324;
}

/// Below this atan(t) rounds to t. The tail is evaluated here instead, because its subnormal powers would be slow.
template <class R>
PLIANT_HD R atan_floor() {
  return R(1e-4f);
}
template <>
PLIANT_HD double atan_floor<double>() {
  return 1e-9;
}

}  // namespace detail

/// The angle of the point (x, y) from the positive x-axis, in [-pi, pi] [rad].
///
/// Error within 4 units in the last place (float and Wide; measured 2.2) or 3 (double) while |x|, |y| are at most half
/// the largest number. Above that: finite, in the right octant, and within 0.33 rad. atan2(0, 0) = 0. The sign of zero
/// is ignored: +pi on the negative x-axis. NaN if an argument is NaN or both are infinite.
template <class R>
PLIANT_HD R atan2(const R& y, const R& x) {
  const R ax = abs(x), ay = abs(y);
  const auto steep = ay > ax;
  const R a = select(steep, ax, ay), b = select(steep, ay, ax);  // select, because min and max would drop a NaN
  // For a / b > 1/2: atan(a / b) = pi/4 + atan((a - b) / (a + b)), which keeps |t| <= 1/2 at the cost of one division.
  const auto upper = a + a > b;
  const R numerator = select(upper, a - b, a), denominator = select(upper, a + b, b);
  const R t = numerator / max(detail::least_positive<R>(), denominator);
  const R u = max(abs(t), detail::atan_floor<R>());
  const R z = u * u;
  const R tail = t + t * (z * detail::atan_tail(z));
  const R octant = select(upper, tail + constant<R>(0.78539816339744830962), tail);
  const R quadrant = select(steep, constant<R>(1.57079632679489661923) - octant, octant);
  const R half = select(x < R(0), constant<R>(3.14159265358979323846) - quadrant, quadrant);
  return select(y < R(0), -half, half);
}

/// The angle in [0, pi] [rad] whose cosine is x, which is
/// clamped to [-1, 1]. Within 4 units in the last place.
template <class R>
PLIANT_HD R acos(const R& x) {
  // Outside [-1, 1] the height is 0, so only the sign of x matters. A NaN passes through x.
  const R height = sqrt(max((R(1) - x) * (R(1) + x), R(0)));
  return atan2(height, x);
}

/// The sine and cosine of one angle.
struct SineCosine {
  double sine, cosine;
};

namespace detail {

/// For |r| <= 0.8 rad, by Taylor series: the first omitted terms, r^19/19! and r^18/18!, are below 1e-17.
PLIANT_HD SineCosine sine_cosine_near_zero(double r) {
  const double z = r * r, z2 = z * z, z4 = z2 * z2;
  const double s =
      ((-1.0 / 6 + z * (1.0 / 120)) + z2 * (-1.0 / 5040 + z * (1.0 / 362880))) +
      z4 * ((-1.0 / 39916800 + z * (1.0 / 6227020800)) + z2 * (-1.0 / 1307674368000 + z * (1.0 / 355687428096000)));
  const double c = ((1.0 / 24 + z * (-1.0 / 720)) + z2 * (1.0 / 40320 + z * (-1.0 / 3628800))) +
                   z4 * ((1.0 / 479001600 + z * (-1.0 / 87178291200)) + z2 * (1.0 / 20922789888000));
  return {r + r * (z * s), (1 - 0.5 * z) + z2 * c};
}

/// The sine and cosine of an angle increased by `quarters` right angles; `quarters` is a whole number.
PLIANT_HD SineCosine turned(const SineCosine& of, double quarters) {
  const double quadrant = quarters - 4 * __builtin_floor(quarters * 0.25);
  const bool swapped = quadrant == 1 || quadrant == 3;
  const double first = swapped ? of.cosine : of.sine, second = swapped ? of.sine : of.cosine;
  return {quadrant >= 2 ? -first : first, quadrant == 1 || quadrant == 2 ? -second : second};
}

}  // namespace detail

/// Sine and cosine of x [rad]: within 3 units in the
/// last place up to |x| = 1.6e6, beyond as if x erred by
/// 2^-51 |x|. Always in [-1, 1]; NaN if x is not finite.
PLIANT_HD SineCosine sine_cosine(double x) {
  // x = k pi/2 + r, |r| <= pi/4. The first two parts of pi/2 have 33 bits, so that k times them is exact (Cody and
  // Waite).
  const double k = __builtin_floor(x * 0.6366197723675814 + 0.5);
  const double r = ((x - k * 0x1.921fb544p+0) - k * 0x1.0b4611a6p-34) - k * 0x1.3198a2e037073p-69;
  // If k is too large for the split of pi/2, r is wrong; then 0 is used instead.
  return detail::turned(detail::sine_cosine_near_zero(select(abs(r) > 0.8, 0.0, r)), k);
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90.
PLIANT_HD SineCosine sine_cosine_of_degrees(double degrees) {
  const double k = __builtin_floor(degrees * (1.0 / 90) + 0.5);
  return detail::turned(detail::sine_cosine_near_zero((degrees - 90 * k) * 0.017453292519943295), k);
}

PLIANT_HD double sin(double x) { return sine_cosine(x).sine; }
PLIANT_HD double cos(double x) { return sine_cosine(x).cosine; }
PLIANT_HD float sin(float x) { return static_cast<float>(sine_cosine(x).sine); }
PLIANT_HD float cos(float x) { return static_cast<float>(sine_cosine(x).cosine); }

namespace detail {

/// (e^r - 1 - r) / r^2 for |r| <= 0.35: Taylor series up to r^13 / 13!.
PLIANT_HD double exp_tail(double r) {
  const double r2 = r * r, r4 = r2 * r2;
  const double a = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const double b = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const double c = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  return (a + r4 * b) + (r4 * r4) * c;
}

/// 2^n for n in [-1022, 1023], by its bits.
PLIANT_HD double power_of_two(std::int64_t n) { return bits_as<double>(static_cast<std::uint64_t>(n + 1023) << 52); }

/// log((1 + f) / (1 - f)) for |f| <= 0.172: 2 (f + f^3/3 + f^5/5 + ... + f^21/21).
PLIANT_HD double log_of_ratio(double f) {
  const double z = f * f, z2 = z * z, z4 = z2 * z2;
  const double a = (1.0 / 3 + z * (1.0 / 5)) + z2 * (1.0 / 7 + z * (1.0 / 9));
  const double b = (1.0 / 11 + z * (1.0 / 13)) + z2 * (1.0 / 15 + z * (1.0 / 17));
  const double c = 1.0 / 19 + z * (1.0 / 21);
  const double series = (a + z4 * b) + (z4 * z4) * c;
  return 2 * f + 2 * f * (z * series);
}

}  // namespace detail

/// e^x, within 2 units in the last place; 0 below -745.2, infinity above 709.8.
PLIANT_HD double exp(double x) {
  const double bounded = clamp(x, -746.0, 710.0);
  const double k = __builtin_floor(bounded * 1.4426950408889634 + 0.5);
  const double r =
      (bounded - k * 0x1.62e42fee00000p-1) - k * 0x1.a39ef35793c76p-33;  // the first part has 32 bits: exact
  const double fraction = 1 + (r + (r * r) * detail::exp_tail(r));
  const std::int64_t n = static_cast<std::int64_t>(k), half = n / 2;  // two factors, because 2^n alone may overflow
  return select(x == x, (fraction * detail::power_of_two(half)) * detail::power_of_two(n - half), x);
}
PLIANT_HD float exp(float x) { return static_cast<float>(exp(static_cast<double>(x))); }

/// e^x - 1 without cancellation near 0: within 4 units in the last place.
PLIANT_HD double expm1(double x) { return abs(x) < 0.34 ? x + (x * x) * detail::exp_tail(x) : exp(x) - 1; }

/// The natural logarithm, within 2 units in the last place; -infinity of 0, NaN below.
PLIANT_HD double log(double x) {
  if (!(x > 0)) return x == 0 ? -__builtin_inf() : __builtin_nan("");
  if (x > 1.7976931348623157e308) return x;
  const bool subnormal = x < 2.2250738585072014e-308;
  const std::uint64_t bits = bits_as<std::uint64_t>(subnormal ? x * 18014398509481984.0 : x);  // 2^54
  const double m = bits_as<double>((bits & 0xfffffffffffffull) | 0x3ff0000000000000ull);       // in [1, 2)
  const bool upper = m > 1.4142135623730951;
  const double mantissa = upper ? 0.5 * m : m;  // in [sqrt(1/2), sqrt(2)]
  const double k =
      static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023 - (subnormal ? 54 : 0) + (upper ? 1 : 0));
  const double part = detail::log_of_ratio((mantissa - 1) / (mantissa + 1));
  return k * 0x1.62e42fee00000p-1 + (k * 0x1.a39ef35793c76p-33 + part);
}
PLIANT_HD float log(float x) { return static_cast<float>(log(static_cast<double>(x))); }

/// log(1 + x) without cancellation near 0: within 4 units in the last place.
PLIANT_HD double log1p(double x) { return abs(x) < 0.29 ? detail::log_of_ratio(x / (2 + x)) : log(1 + x); }

/// x^y for x >= 0 as e^(y log x): relative error at most 4e-16 (1 + |y log x|). x^0 = 1 even for 0; NaN for x < 0.
///
/// To distribute a stiffness over n projections, 1 - (1 - k)^(1/n), use
/// -expm1(log1p(-k) / n), which stays accurate for small k and large n.
PLIANT_HD double pow(double x, double y) { return y == 0 ? 1 : exp(y * log(x)); }

}  // namespace pliant
