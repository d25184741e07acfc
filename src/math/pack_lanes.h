// What searches in lanes share: they compare a vector of items at a time, and keep those that are near.
//
// Packing moves the lanes whose bits are set to the front, in order: by one instruction (AVX-512), by a permutation
// from a table (AVX2, SSSE3, WebAssembly), or lane by lane.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "math/lane_bits.h"
#include "math/wide.h"

#if PLIANT_X86_BITS > 0
#include <immintrin.h>
#endif

namespace pliant {
inline namespace PLIANT_ISA {

PLIANT_HD Part load_part(const float* from) {
  Part a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
PLIANT_HD PartMask load_part(const std::int32_t* from) {
  PartMask a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
PLIANT_HD Part all_lanes(float a) { return a - Part{}; }

PLIANT_HD PartMask lane_numbers() {
  constexpr std::int32_t numbers[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load_part(numbers);
}

/// How far places are from an interval, along one axis.
PLIANT_HD Part beyond(const Part& x, const Part& low, const Part& high) {
  return max_part(max_part(low - x, x - high), Part{});
}

/// The bits of the first lanes, if there are `left` (>= 1) items left.
PLIANT_HD std::uint32_t first_bits(int left) {
  return left < part_width ? (1u << left) - 1 : static_cast<std::uint32_t>((std::uint64_t{1} << part_width) - 1);
}

/// Bit i is set where lane i of a is at most that of b.
PLIANT_HD std::uint32_t bits_at_most(const Part& a, const Part& b) {
#if PLIANT_X86_BITS == 512
  return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LE_OQ);
#else
  return part_bits(a <= b);
#endif
}

/// The bits of the lanes that differ from a number.
PLIANT_HD std::uint32_t bits_other_than(const PartMask& a, std::int32_t number) {
#if PLIANT_X86_BITS == 512
  return _mm512_cmpneq_epi32_mask((__m512i)a, _mm512_set1_epi32(number));
#else
  return part_bits(a != PartMask{} + number);
#endif
}

PLIANT_HD int count_bits(std::uint32_t bits) { return __builtin_popcount(bits); }

#if PLIANT_X86_BITS == 256
/// For each set of bits: the lanes that are set, as bytes.
constexpr std::array<std::uint64_t, 256> make_packing_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint32_t bits = 0; bits < 256; ++bits) {
    int to = 0;
    for (std::uint64_t lane = 0; lane < 8; ++lane)
      if ((bits >> lane & 1u) != 0) table[bits] |= lane << (8 * to++);
  }
  return table;
}
#elif PLIANT_X86_BITS == 128 || defined(__wasm_simd128__)
/// For each set of bits: the bytes of the lanes that are set.
constexpr std::array<std::array<std::uint8_t, 16>, 16> make_packing_table() {
  std::array<std::array<std::uint8_t, 16>, 16> table{};
  for (std::uint32_t bits = 0; bits < 16; ++bits) {
    int to = 0;
    for (int lane = 0; lane < 4; ++lane)
      if ((bits >> lane & 1u) != 0)
        for (int byte = 0; byte < 4; ++byte) table[bits][to++] = static_cast<std::uint8_t>(4 * lane + byte);
  }
  return table;
}
#endif

#if PLIANT_X86_BITS == 256 || PLIANT_X86_BITS == 128 || defined(__wasm_simd128__)
constexpr auto packing_table =
    make_packing_table();  // of each unit its own: a local of a function would be shared by all
#endif

/// How lanes move for a set of bits; for several vectors.
class Packing {
 public:
  PLIANT_HD explicit Packing(std::uint32_t bits) : bits_(bits) {
#if PLIANT_X86_BITS == 256
    lanes_ = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(packing_table[bits])));
#elif PLIANT_X86_BITS == 128 || defined(__wasm_simd128__)
    std::memcpy(&bytes_, packing_table[bits].data(), sizeof bytes_);
#endif
  }

  /// Stores all lanes of a; the first of them are those that are set.
  PLIANT_HD void store(void* to, const PartMask& a) const {
#if PLIANT_X86_BITS == 512
    const __m512i packed = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits_), (__m512i)a);
    std::memcpy(to, &packed, sizeof packed);
#elif PLIANT_X86_BITS == 256
    const __m256i packed = _mm256_permutevar8x32_epi32((__m256i)a, lanes_);
    std::memcpy(to, &packed, sizeof packed);
#elif PLIANT_X86_BITS == 128
    const __m128i packed = _mm_shuffle_epi8((__m128i)a, bytes_);
    std::memcpy(to, &packed, sizeof packed);
#elif defined(__wasm_simd128__)
    const Bytes packed = __builtin_wasm_swizzle_i8x16((Bytes)a, bytes_);
    std::memcpy(to, &packed, sizeof packed);
#else
    auto* next = static_cast<unsigned char*>(to);
    for (int lane = 0; lane < part_width; ++lane) {
      const std::int32_t value = a[lane];
      std::memcpy(next, &value, sizeof value);
      next += (bits_ >> lane & 1u) != 0 ? sizeof value : 0;
    }
#endif
  }

 private:
  [[maybe_unused]] std::uint32_t bits_;  // vectors of 4 and 8 lanes move by a table instead
#if PLIANT_X86_BITS == 256
  __m256i lanes_;
#elif PLIANT_X86_BITS == 128
  __m128i bytes_;
#elif defined(__wasm_simd128__)
  typedef signed char Bytes __attribute__((vector_size(16)));
  Bytes bytes_;
#endif
};

}  // namespace PLIANT_ISA
}  // namespace pliant
