// Random numbers that are the same everywhere.
#pragma once

#include <cmath>
#include <cstdint>

#include "pliant/vec3.h"

namespace pliant {

/// Random numbers in [0, 1) from a counter (SplitMix64: Steele, Lea and Flood 2014).
class Random {
 public:
  explicit Random(int seed) : state_(static_cast<std::uint64_t>(seed) << 32) {}

  float next() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t bits = state_;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return static_cast<float>((bits ^ (bits >> 31)) >> 40) / static_cast<float>(1 << 24);
  }
  float between(float low, float high) { return low + (high - low) * next(); }

  /// A rotation, uniform over all: a point of the 4-ball, by rejection, on its sphere.
  Quatf rotation() {
    for (;;) {
      const Quatf q{between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
      const float square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
      if (square > 1 || square < 0.01f) continue;
      const float scale = 1 / std::sqrt(square);
      return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace pliant
