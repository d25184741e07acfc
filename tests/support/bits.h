// Bitwise comparison of floats, and random floats that break careless formulas.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "math/scalar.h"

namespace pliant::testing_support {

/// True if both floats have the same bits. Two NaN always count as equal, because their payloads differ between
/// machines.
inline bool same_bits(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || bits_as<std::uint32_t>(a) == bits_as<std::uint32_t>(b);
}

/// A random float: mostly an ordinary number around 1, else a zero of either sign, subnormal, huge, infinite or NaN.
inline float nasty_float(std::mt19937& random) {
  constexpr float special[] = {0.f,
                               -0.f,
                               1.f,
                               -1.f,
                               1e-45f,
                               -1e-42f,
                               1.17549435e-38f,
                               3.4e38f,
                               -3.4e38f,
                               1e-20f,
                               1e20f,
                               std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN(),
                               3.14159274f,
                               -3.14159274f};
  const std::uint32_t kind = random() % 16;
  const float unit = static_cast<float>(random()) * (2.f / 4294967296.f) - 1;
  if (kind == 0) return special[random() % (sizeof special / sizeof *special)];
  if (kind == 1) return std::ldexp(unit, static_cast<int>(random() % 200) - 100);
  if (kind == 2)
    return static_cast<float>(static_cast<int>(random() % 3) -
                              1);  // -1, 0 or 1, for coincident points and right angles
  return unit;
}

}  // namespace pliant::testing_support
