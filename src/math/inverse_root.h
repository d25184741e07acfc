// 1 / sqrt(x) without division or root: an integer guess and two Newton steps. Only shifts,
// subtractions and products, so the bits are the same everywhere. Relative error 5e-6.
#pragma once

#include "math/scalar.h"

namespace pliant {

/// x must be finite, and at least 1e-37.
PLIANT_HD float inverse_root(float x) {
  std::int32_t bits = bits_as<std::int32_t>(x);
  bits = 0x5f375a86 - (bits >> 1);
  float y = bits_as<float>(bits);
  const float half = 0.5f * x;
  y = y * (1.5f - half * y * y);
  return y * (1.5f - half * y * y);
}

}  // namespace pliant
