// Sixteen booleans as the bits of a number, so that a loop visits only the lanes that are set.
#pragma once

#include <cstdint>

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

/// Bit i is lane i of a part of a mask.
PLIANT_HD std::uint32_t part_bits(const PartMask& mask) {
#if PLIANT_X86_BITS == 512
  return static_cast<std::uint32_t>(_mm512_movepi32_mask((__m512i)mask));
#elif PLIANT_X86_BITS == 256
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask));
#elif PLIANT_X86_BITS == 128
  return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask));
#elif defined(__wasm_simd128__)
  return static_cast<std::uint32_t>(__builtin_wasm_bitmask_i32x4(mask));
#else
  std::uint32_t bits = 0;
  for (int lane = 0; lane < part_width; ++lane) bits |= mask[lane] != 0 ? 1u << lane : 0u;
  return bits;
#endif
}

/// Bit i is lane i of the mask.
PLIANT_HD std::uint32_t lane_bits(const WideMask& mask) {
  std::uint32_t bits = 0;
  PLIANT_EACH_PART(bits |= part_bits(mask.part[i]) << (part_width * i))
  return bits;
}

/// True if a number is zero in all lanes.
PLIANT_HD bool all_zero(const Wide& value) { return lane_bits(value == Wide(0.f)) == 0xffff; }

}  // namespace PLIANT_ISA
}  // namespace pliant
