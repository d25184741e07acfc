// WideDouble: eight doubles with the interface of one, half of the lanes of a Wide. Every operation is the IEEE
// operation per lane.
#pragma once

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

inline constexpr int wide_double_width = 8;

typedef double DoublePart __attribute__((vector_size(4 * PLIANT_PART_WIDTH)));
typedef std::int64_t DoublePartMask __attribute__((vector_size(4 * PLIANT_PART_WIDTH)));
/// As many floats as a part has doubles.
typedef float HalfPart __attribute__((vector_size(2 * PLIANT_PART_WIDTH)));

/// Eight booleans.
struct WideDoubleMask {
  DoublePartMask part[wide_parts];
};

/// Eight doubles, one for each lane.
struct WideDouble {
  DoublePart part[wide_parts];

  WideDouble() = default;
  /// Sets every lane to `value`.
  PLIANT_HD explicit WideDouble(double value) {
    for (int i = 0; i < wide_parts; ++i)
      part[i] = value - DoublePart{};  // x - 0 is exact for every x; x + 0 changes -0
  }
};

#define PLIANT_WIDE_OPERATOR(op)                                               \
  PLIANT_HD WideDouble operator op(const WideDouble& a, const WideDouble& b) { \
    WideDouble r;                                                              \
    PLIANT_EACH_PART(r.part[i] = a.part[i] op b.part[i])                       \
    return r;                                                                  \
  }
PLIANT_WIDE_OPERATOR(+)
PLIANT_WIDE_OPERATOR(-)
PLIANT_WIDE_OPERATOR(*)
PLIANT_WIDE_OPERATOR(/)
#undef PLIANT_WIDE_OPERATOR

#define PLIANT_WIDE_COMPARISON(op)                                                 \
  PLIANT_HD WideDoubleMask operator op(const WideDouble& a, const WideDouble& b) { \
    WideDoubleMask r;                                                              \
    PLIANT_EACH_PART(r.part[i] = a.part[i] op b.part[i])                           \
    return r;                                                                      \
  }
PLIANT_WIDE_COMPARISON(<)
PLIANT_WIDE_COMPARISON(>)
#undef PLIANT_WIDE_COMPARISON

PLIANT_HD WideDouble operator-(const WideDouble& a) {
  WideDouble r;
  PLIANT_EACH_PART(r.part[i] = -a.part[i])
  return r;
}

/// In each lane: a where the mask is set, else b.
PLIANT_HD WideDouble select(const WideDoubleMask& mask, const WideDouble& a, const WideDouble& b) {
  WideDouble r;
  PLIANT_EACH_PART(r.part[i] = mask.part[i] ? a.part[i] : b.part[i])
  return r;
}

/// Eight consecutive floats as doubles.
PLIANT_HD void load_row(const float* from, WideDouble& to) {
  PLIANT_EACH_PART({
    HalfPart half;
    std::memcpy(&half, from + part_width / 2 * i, sizeof half);
    to.part[i] = __builtin_convertvector(half, DoublePart);
  });
}
/// Eight doubles as consecutive floats, rounded to nearest.
PLIANT_HD void store_row(float* to, const WideDouble& from) {
  PLIANT_EACH_PART({
    const HalfPart half = __builtin_convertvector(from.part[i], HalfPart);
    std::memcpy(to + part_width / 2 * i, &half, sizeof half);
  });
}

}  // namespace PLIANT_ISA
}  // namespace pliant
