// 1 / sqrt(x) of math/inverse_root.h in each of sixteen lanes.
#pragma once

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

/// Each x must be finite, and at least 1e-37.
PLIANT_HD Wide inverse_root(const Wide& x) {
  Wide y;
  PLIANT_EACH_PART(y.part[i] = (Part)(0x5f375a86 - ((PartMask)x.part[i] >> 1)))
  const Wide half = Wide(0.5f) * x, three_halves(1.5f);
  y = y * (three_halves - half * y * y);
  return y * (three_halves - half * y * y);
}

}  // namespace PLIANT_ISA
}  // namespace pliant
