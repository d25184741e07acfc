// Sixteen booleans as the bits of a number, so that a loop visits only the lanes that are set.
#pragma once

#include <cstdint>

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

/// Bit i is lane i of the mask.
PLIANT_HD std::uint32_t lane_bits(const WideMask& mask) {
#if PLIANT_X86_BITS == 512
  return static_cast<std::uint32_t>(_mm512_movepi32_mask((__m512i)mask.part[0]));
#elif PLIANT_X86_BITS == 256
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask.part[0]) | _mm256_movemask_ps((__m256)mask.part[1])
                                                                                   << 8);
#elif PLIANT_X86_BITS == 128
  std::uint32_t bits = 0;
  PLIANT_EACH_PART(bits |= static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask.part[i])) << (4 * i))
  return bits;
#else
  std::uint32_t bits = 0;
  for (int lane = 0; lane < wide_width; ++lane)
    bits |= mask.part[lane / part_width][lane % part_width] != 0 ? 1u << lane : 0u;
  return bits;
#endif
}

/// True if a number is zero in all lanes.
PLIANT_HD bool all_zero(const Wide& value) { return lane_bits(value == Wide(0.f)) == 0xffff; }

}  // namespace PLIANT_ISA
}  // namespace pliant
