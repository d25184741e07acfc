// The few operations that every scalar type of the engine has under the same names: float, double, and Wide beside them.
//
// Formulas call these by plain name (argument-dependent lookup finds those of Wide), so that one text runs on a single
// particle, on sixteen lanes and on a CUDA device and gives the same bits. Hence min and max are spelt out as the one
// comparison that SSE's minps and maxps make: where a is NaN, or where both are zero, the second argument is the answer.
#pragma once

#include <cstdint>
#include <cstring>

#include "pliant/vec3.h"

namespace pliant {

/// `a` where the mask holds, else `b`.
PLIANT_HD float select(bool mask, float a, float b) { return mask ? a : b; }
PLIANT_HD double select(bool mask, double a, double b) { return mask ? a : b; }

/// The smaller; b where they compare unordered or equal.
PLIANT_HD float min(float a, float b) { return a < b ? a : b; }
PLIANT_HD double min(double a, double b) { return a < b ? a : b; }

/// The larger; b where they compare unordered or equal.
PLIANT_HD float max(float a, float b) { return a > b ? a : b; }
PLIANT_HD double max(double a, double b) { return a > b ? a : b; }

/// The magnitude: clears the sign bit, also of zero and NaN.
PLIANT_HD float abs(float a) { return __builtin_fabsf(a); }
PLIANT_HD double abs(double a) { return __builtin_fabs(a); }

/// The square root, correctly rounded on every machine that follows IEEE 754; NaN below zero.
PLIANT_HD float sqrt(float a) {
#if defined(__CUDA_ARCH__)
  return __fsqrt_rn(a);
#else
  return __builtin_sqrtf(a);
#endif
}
PLIANT_HD double sqrt(double a) {
#if defined(__CUDA_ARCH__)
  return __dsqrt_rn(a);
#else
  return __builtin_sqrt(a);
#endif
}

/// `a` between `low` and `high`; `high` wins where they cross.
template <class R>
PLIANT_HD R clamp(const R& a, const R& low, const R& high) {
  return min(max(a, low), high);
}

/// The bits of `from` as a `To` of the same size (std::bit_cast, which not every compiler of ours has).
template <class To, class From>
PLIANT_HD To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "only between types of one size");
  To to;
#if defined(__CUDA_ARCH__)
  memcpy(&to, &from, sizeof(To));
#else
  std::memcpy(&to, &from, sizeof(To));
#endif
  return to;
}

}  // namespace pliant
