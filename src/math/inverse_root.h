// 1 / sqrt(x) without division or root: an integer guess and two Newton steps, for one float and for sixteen lanes. Only shifts,
// subtractions and products, so the bits are the same everywhere. Relative error 5e-6.
#pragma once

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

/// x must be finite, and at least 1e-37.
PLIANT_HD float inverse_root(float x) {
  std::int32_t bits = bits_as<std::int32_t>(x);
  bits = 0x5f375a86 - (bits >> 1);
  float y = bits_as<float>(bits);
  const float half = 0.5f * x;
  y = y * (1.5f - half * y * y);
  return y * (1.5f - half * y * y);
}

PLIANT_HD Wide inverse_root(const Wide& x) {
  Wide y;
  PLIANT_EACH_PART(y.part[i] = (Part)(0x5f375a86 - ((PartMask)x.part[i] >> 1)))
  const Wide half = Wide(0.5f) * x, three_halves(1.5f);
  y = y * (three_halves - half * y * y);
  return y * (three_halves - half * y * y);
}

}  // namespace PLIANT_ISA
}  // namespace pliant
