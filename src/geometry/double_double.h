// Double-double arithmetic: the unevaluated sum of two doubles, about 32 digits.
//
// A scalar type for the rare decisions that double precision leaves open. Dekker 1971, "A
// floating-point technique for extending the available precision". No fused multiply-add,
// so the bits are the same everywhere. Host only and not force-inlined: each operation is
// twenty, and long formulas took minutes to compile under the sanitizers.
#pragma once

#include "math/scalar.h"

namespace pliant {

struct DoubleDouble {
  double high = 0, low = 0;  ///< |low| at most half a unit in the last place of `high`

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor): implicit, as float to double is
  DoubleDouble(double h, double l) : high(h), low(l) {}
  explicit operator double() const { return high; }
};

namespace detail {

/// a + b exactly, if |a| >= |b| or a = 0.
inline DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a b exactly, without overflow or underflow.
inline DoubleDouble two_product(double a, double b) {
  constexpr double splitter = 134217729;  // 2^27 + 1 divides a double into two halves of its bits
  const double product = a * b, a_scaled = splitter * a, b_scaled = splitter * b;
  const double a_high = a_scaled - (a_scaled - a), a_low = a - a_high;
  const double b_high = b_scaled - (b_scaled - b), b_low = b - b_high;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

}  // namespace detail

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = detail::two_sum(a.high, b.high), low = detail::two_sum(a.low, b.low);
  const DoubleDouble sum = detail::fast_two_sum(high.high, high.low + low.high);
  return detail::fast_two_sum(sum.high, sum.low + low.low);
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = detail::two_product(a.high, b.high);
  return detail::fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(first);
  const double second = rest.high / b.high;
  const DoubleDouble left = rest - b * DoubleDouble(second);
  return detail::fast_two_sum(first, second) + DoubleDouble(left.high / b.high);
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
inline bool operator<=(const DoubleDouble& a, const DoubleDouble& b) {
  return a.high < b.high || (a.high == b.high && a.low <= b.low);
}
inline bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }

inline DoubleDouble select(bool mask, const DoubleDouble& a, const DoubleDouble& b) { return mask ? a : b; }
inline DoubleDouble min(const DoubleDouble& a, const DoubleDouble& b) { return a < b ? a : b; }
inline DoubleDouble max(const DoubleDouble& a, const DoubleDouble& b) { return a > b ? a : b; }
inline DoubleDouble abs(const DoubleDouble& a) { return a.high < 0 ? -a : a; }

/// One Newton step from the double root; NaN below zero.
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (a.high == 0) return {};
  const double root = sqrt(a.high);
  const DoubleDouble rest = a - detail::two_product(root, root);
  return detail::fast_two_sum(root, rest.high / (2 * root));
}

/// The relative error of a few operations together: 2^-102.
inline DoubleDouble unit_roundoff(const DoubleDouble&) { return {2e-31}; }

}  // namespace pliant
