// Wide: sixteen floats with the interface of one. A unit that defines PLIANT_ONE_REGISTER gets as many floats as a
// native vector has, and walks over a batch of sixteen itself (math/isa.h).
//
// One logical width on every machine, so that the grouping of constraints is machine-independent. It
// is stored as an array of native vectors (four of SSE, two of AVX2, one of AVX-512). A raw 64-byte
// vector type also compiles, but g++ spills it on AVX2 and runs four times slower. Every operation
// is the IEEE operation per lane, so lanes give the bits of plain floats; tests verify that.
//
// Everything lives in an inline namespace named after the instruction set that this unit is compiled for: the sweeps
// are built once for each level (math/levels.h) into one program, and nothing of one build may be linked into another.
// The generic level has parts of 16 bytes in the compiler's own vector types and names no instruction; it compiles on
// any CPU.
#pragma once

#include <cstdint>
#include <cstring>

#include "math/isa.h"
#include "math/scalar.h"
#include "math/unroll.h"
#include "pliant/state.h"
#include "pliant/vec3.h"

// The header of 128-bit registers alone takes a quarter of the time.
#if PLIANT_X86_BITS > 128
#include <immintrin.h>
#elif PLIANT_X86_BITS == 128
#include <xmmintrin.h>
#endif

namespace pliant {
inline namespace PLIANT_ISA {

inline constexpr int wide_width = PLIANT_WIDE_WIDTH;
inline constexpr int part_width = PLIANT_PART_WIDTH;
inline constexpr int wide_parts = wide_width / part_width;

typedef float Part __attribute__((vector_size(4 * PLIANT_PART_WIDTH)));
typedef std::int32_t PartMask __attribute__((vector_size(4 * PLIANT_PART_WIDTH)));
typedef float Quad __attribute__((vector_size(16)));

/// A boolean for each lane. A lane is true if all its bits are set.
struct WideMask {
  PartMask part[wide_parts];
};

/// Floats, one for each lane: sixteen, unless a unit asks for one register.
struct Wide {
  Part part[wide_parts];

  Wide() = default;
  /// Sets every lane to `value`.
  PLIANT_HD explicit Wide(float value) {
    for (int i = 0; i < wide_parts; ++i) part[i] = value - Part{};  // x - 0 is exact for every x; x + 0 changes -0
  }
};

// Loops over parts are unrolled by hand, because not every compiler does so early enough to keep the parts in
// registers.
#if PLIANT_WIDE_WIDTH == PLIANT_PART_WIDTH
#define PLIANT_EACH_PART(...) \
  {                           \
    constexpr int i = 0;      \
    __VA_ARGS__;              \
  }
#elif PLIANT_WIDE_WIDTH == 2 * PLIANT_PART_WIDTH
#define PLIANT_EACH_PART(...) \
  {                           \
    {                         \
      constexpr int i = 0;    \
      __VA_ARGS__;            \
    }                         \
    {                         \
      constexpr int i = 1;    \
      __VA_ARGS__;            \
    }                         \
  }
#else
#define PLIANT_EACH_PART(...) \
  {                           \
    {                         \
      constexpr int i = 0;    \
      __VA_ARGS__;            \
    }                         \
    {                         \
      constexpr int i = 1;    \
      __VA_ARGS__;            \
    }                         \
    {                         \
      constexpr int i = 2;    \
      __VA_ARGS__;            \
    }                         \
    {                         \
      constexpr int i = 3;    \
      __VA_ARGS__;            \
    }                         \
  }
#endif

#define PLIANT_WIDE_OPERATOR(op)                             \
  PLIANT_HD Wide operator op(const Wide& a, const Wide& b) { \
    Wide r;                                                  \
    PLIANT_EACH_PART(r.part[i] = a.part[i] op b.part[i])     \
    return r;                                                \
  }
PLIANT_WIDE_OPERATOR(+)
PLIANT_WIDE_OPERATOR(-)
PLIANT_WIDE_OPERATOR(*)
PLIANT_WIDE_OPERATOR(/)
#undef PLIANT_WIDE_OPERATOR

#define PLIANT_WIDE_COMPARISON(op)                               \
  PLIANT_HD WideMask operator op(const Wide& a, const Wide& b) { \
    WideMask r;                                                  \
    PLIANT_EACH_PART(r.part[i] = a.part[i] op b.part[i])         \
    return r;                                                    \
  }
PLIANT_WIDE_COMPARISON(<)
PLIANT_WIDE_COMPARISON(>)
PLIANT_WIDE_COMPARISON(<=)
PLIANT_WIDE_COMPARISON(>=)
PLIANT_WIDE_COMPARISON(==)
#undef PLIANT_WIDE_COMPARISON

PLIANT_HD Wide operator-(const Wide& a) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = -a.part[i])
  return r;
}
PLIANT_HD Wide& operator+=(Wide& a, const Wide& b) { return a = a + b; }
PLIANT_HD Wide& operator-=(Wide& a, const Wide& b) { return a = a - b; }

/// True if any lane is set.
PLIANT_HD bool any(const WideMask& mask) {
  std::uint64_t bits[sizeof(WideMask) / 8], all = 0;
  std::memcpy(bits, &mask, sizeof bits);
  for (const std::uint64_t some : bits) all |= some;
  return all != 0;
}

/// In each lane: a where the mask is set, else b.
PLIANT_HD Wide select(const WideMask& mask, const Wide& a, const Wide& b) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = mask.part[i] ? a.part[i] : b.part[i])
  return r;
}
/// a < b ? a : b, like the hardware minimum, including zeros and NaN; g++ would emit two instructions for the
/// expression.
PLIANT_HD Part min_part(const Part& a, const Part& b) {
#if PLIANT_X86_BITS == 512
  return (Part)_mm512_maskz_min_ps(0xffff, (__m512)a,
                                   (__m512)b);  // the unmasked form makes g++ 12 warn of its own header
#elif PLIANT_X86_BITS == 256
  return (Part)_mm256_min_ps((__m256)a, (__m256)b);
#elif PLIANT_X86_BITS == 128
  return (Part)_mm_min_ps((__m128)a, (__m128)b);
#else
  return a < b ? a : b;
#endif
}
PLIANT_HD Part max_part(const Part& a, const Part& b) {
#if PLIANT_X86_BITS == 512
  return (Part)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
#elif PLIANT_X86_BITS == 256
  return (Part)_mm256_max_ps((__m256)a, (__m256)b);
#elif PLIANT_X86_BITS == 128
  return (Part)_mm_max_ps((__m128)a, (__m128)b);
#elif defined(__wasm_simd128__)
  return (Part)__builtin_wasm_pmax_f32x4(b, a);  // clang 14 finds it for the minimum alone
#else
  return a > b ? a : b;
#endif
}
PLIANT_HD Wide min(const Wide& a, const Wide& b) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = min_part(a.part[i], b.part[i]))
  return r;
}
PLIANT_HD Wide max(const Wide& a, const Wide& b) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = max_part(a.part[i], b.part[i]))
  return r;
}
PLIANT_HD Wide abs(const Wide& a) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = (Part)((PartMask)a.part[i] & 0x7fffffff))
  return r;
}
PLIANT_HD Part sqrt_part(const Part& a) {
#if PLIANT_X86_BITS == 512
  return (Part)_mm512_maskz_sqrt_ps(0xffff, (__m512)a);  // the unmasked form makes g++ 12 warn of its own header
#elif PLIANT_X86_BITS == 256
  return (Part)_mm256_sqrt_ps((__m256)a);
#elif PLIANT_X86_BITS == 128
  return (Part)_mm_sqrt_ps((__m128)a);
#elif defined(__wasm_simd128__)
  return (Part)__builtin_wasm_sqrt_f32x4(a);
#else
  Part r = a;
  for (int lane = 0; lane < part_width; ++lane) r[lane] = pliant::sqrt(a[lane]);
  return r;
#endif
}
PLIANT_HD Wide sqrt(const Wide& a) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = sqrt_part(a.part[i]))
  return r;
}

/// Loads sixteen consecutive floats, one for each lane.
PLIANT_HD Wide load_wide(const float* from) {
  Wide r;
  std::memcpy(&r, from, sizeof(Wide));
  return r;
}
PLIANT_HD void store_wide(float* to, const Wide& a) { std::memcpy(to, &a, sizeof(Wide)); }

// ---------------------------------------------------------------- loading and storing records
//
// Lane 4 L + j of a Wide holds the particle of constraint 4 L + j. Register j holds the records of lanes j, 4 + j, 8 +
// j and 12 + j; the 4 x 4 transpose in each 128-bit part gives x, y, z and w. A contiguous group of four records fills
// a register with one load; it needs one base index for four constraints.

#if PLIANT_PART_WIDTH == 16
#define PLIANT_SHUFFLE(a, b, p, q, r, s)                                                                          \
  __builtin_shufflevector(a, b, p, q, 12 + (r), 12 + (s), 4 + (p), 4 + (q), 16 + (r), 16 + (s), 8 + (p), 8 + (q), \
                          20 + (r), 20 + (s), 12 + (p), 12 + (q), 24 + (r), 24 + (s))
#elif PLIANT_PART_WIDTH == 8
#define PLIANT_SHUFFLE(a, b, p, q, r, s) \
  __builtin_shufflevector(a, b, p, q, 4 + (r), 4 + (s), 4 + (p), 4 + (q), 8 + (r), 8 + (s))
#else
#define PLIANT_SHUFFLE(a, b, p, q, r, s) __builtin_shufflevector(a, b, p, q, r, s)
#endif
// PLIANT_SHUFFLE(a, b, p, q, r, s): in each 128-bit part, elements p and q of a, then r and s (counted from 4) of b.

/// Transposes the 4 x 4 floats in each 128-bit part of four registers. It is its own inverse.
PLIANT_HD void transpose(Part& a, Part& b, Part& c, Part& d) {
  const Part ab_xy = PLIANT_SHUFFLE(a, b, 0, 1, 4, 5);
  const Part cd_xy = PLIANT_SHUFFLE(c, d, 0, 1, 4, 5);
  const Part ab_zw = PLIANT_SHUFFLE(a, b, 2, 3, 6, 7);
  const Part cd_zw = PLIANT_SHUFFLE(c, d, 2, 3, 6, 7);
  a = PLIANT_SHUFFLE(ab_xy, cd_xy, 0, 2, 4, 6);
  b = PLIANT_SHUFFLE(ab_xy, cd_xy, 1, 3, 5, 7);
  c = PLIANT_SHUFFLE(ab_zw, cd_zw, 0, 2, 4, 6);
  d = PLIANT_SHUFFLE(ab_zw, cd_zw, 1, 3, 5, 7);
}

struct WideRecords {
  Vec3<Wide> position;
  Wide w;
};

PLIANT_HD Quad load_quad(const Record* from) {
  Quad q;
  std::memcpy(&q, from, sizeof q);
  return q;
}

/// Part i of the register with records at[0], at[4], at[8], at[12]. Intrinsics, because g++ needs twice as many
/// shuffles.
PLIANT_HD Part gather_part(const Record* base, const std::int32_t* at, int i) {
#if PLIANT_PART_WIDTH == 16
  (void)i;
  const auto pair = [&](int k) __attribute__((always_inline)) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&base[at[k]].x)), _mm_loadu_ps(&base[at[k + 4]].x),
                                1);
  };
  const __m512d low = _mm512_castpd256_pd512(_mm256_castps_pd(pair(0)));
  return (Part)_mm512_maskz_insertf64x4(0xff, low, _mm256_castps_pd(pair(8)), 1);  // masked as above, against a warning
#elif PLIANT_PART_WIDTH == 8
  const __m256 low = _mm256_castps128_ps256(_mm_loadu_ps(&base[at[8 * i]].x));
  return (Part)_mm256_insertf128_ps(low, _mm_loadu_ps(&base[at[8 * i + 4]].x), 1);
#else
  return load_quad(base + at[4 * i]);
#endif
}

/// Four registers with sixteen records of four floats; register j has those of lanes j, 4 + j, 8 + j and 12 + j.
struct Registers {
  Part at[4][wide_parts];
};

/// Loads sixteen records by index: lane l gets base[index[l]].
PLIANT_HD Registers load_indexed(const Record* base, const std::int32_t* index) {
  Registers r;
  PLIANT_EACH_PART({
    r.at[0][i] = gather_part(base, index, i);
    r.at[1][i] = gather_part(base, index + 1, i);
    r.at[2][i] = gather_part(base, index + 2, i);
    r.at[3][i] = gather_part(base, index + 3, i);
  })
  return r;
}

/// Loads four contiguous groups of four records; group j starts at base[run[j]]: lane 4 L + j gets base[run[j] + L].
PLIANT_HD Registers load_runs(const Record* base, const std::int32_t* run) {
  Registers r;
  std::memcpy(r.at[0], base + run[0], sizeof r.at[0]);
  std::memcpy(r.at[1], base + run[1], sizeof r.at[1]);
  std::memcpy(r.at[2], base + run[2], sizeof r.at[2]);
  std::memcpy(r.at[3], base + run[3], sizeof r.at[3]);
  return r;
}

#define PLIANT_REGISTER_OPERATOR(op)                                        \
  PLIANT_HD Registers operator op(const Registers& a, const Registers& b) { \
    Registers r;                                                            \
    PLIANT_EACH_PART({                                                      \
      r.at[0][i] = a.at[0][i] op b.at[0][i];                                \
      r.at[1][i] = a.at[1][i] op b.at[1][i];                                \
      r.at[2][i] = a.at[2][i] op b.at[2][i];                                \
      r.at[3][i] = a.at[3][i] op b.at[3][i];                                \
    })                                                                      \
    return r;                                                               \
  }
PLIANT_REGISTER_OPERATOR(+)
PLIANT_REGISTER_OPERATOR(-)
#undef PLIANT_REGISTER_OPERATOR

/// All bits set where a record has x, y and z. The table is a local: at namespace scope each unit would export it.
PLIANT_HD PartMask xyz_mask() {
  constexpr std::int32_t xyz_bits[16] = {-1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0};
  PartMask mask;
  std::memcpy(&mask, xyz_bits, sizeof mask);
  return mask;
}

/// A copy of the records with w set to zero.
PLIANT_HD Registers without_w(const Registers& a) {
  Registers r;
  const PartMask mask = xyz_mask();
  PLIANT_EACH_PART({
    r.at[0][i] = (Part)((PartMask)a.at[0][i] & mask);
    r.at[1][i] = (Part)((PartMask)a.at[1][i] & mask);
    r.at[2][i] = (Part)((PartMask)a.at[2][i] & mask);
    r.at[3][i] = (Part)((PartMask)a.at[3][i] & mask);
  })
  return r;
}

PLIANT_HD Part minus_xyz(const Part& a, const Part& b) {
#if PLIANT_X86_BITS == 512
  return (Part)_mm512_mask_sub_ps((__m512)a, 0x7777, (__m512)a, (__m512)b);
#else
  return a - (Part)((PartMask)b & xyz_mask());
#endif
}

/// In each record: a - b in x, y and z, and w of a.
PLIANT_HD Registers minus_xyz(const Registers& a, const Registers& b) {
  Registers r;
  PLIANT_EACH_PART({
    r.at[0][i] = minus_xyz(a.at[0][i], b.at[0][i]);
    r.at[1][i] = minus_xyz(a.at[1][i], b.at[1][i]);
    r.at[2][i] = minus_xyz(a.at[2][i], b.at[2][i]);
    r.at[3][i] = minus_xyz(a.at[3][i], b.at[3][i]);
  })
  return r;
}

/// The w of each record, as one value per lane.
PLIANT_HD Wide w_of(const Registers& a) {
  Wide w;
  PLIANT_EACH_PART({
    const Part ab = PLIANT_SHUFFLE(a.at[0][i], a.at[1][i], 3, 3, 7, 7);
    const Part cd = PLIANT_SHUFFLE(a.at[2][i], a.at[3][i], 3, 3, 7, 7);
    w.part[i] = PLIANT_SHUFFLE(ab, cd, 0, 2, 4, 6);
  })
  return w;
}

/// Transposes records to one value per lane for each of x, y, z and w.
PLIANT_HD WideRecords from_registers(const Registers& from) {
  Registers r = from;
  WideRecords out;
  PLIANT_EACH_PART({
    transpose(r.at[0][i], r.at[1][i], r.at[2][i], r.at[3][i]);
    out.position.x.part[i] = r.at[0][i];
    out.position.y.part[i] = r.at[1][i];
    out.position.z.part[i] = r.at[2][i];
    out.w.part[i] = r.at[3][i];
  })
  return out;
}

/// Transposes values per lane back to records: the inverse of from_registers.
PLIANT_HD Registers to_registers(const WideRecords& a) {
  Registers r;
  PLIANT_EACH_PART({
    r.at[0][i] = a.position.x.part[i];
    r.at[1][i] = a.position.y.part[i];
    r.at[2][i] = a.position.z.part[i];
    r.at[3][i] = a.w.part[i];
    transpose(r.at[0][i], r.at[1][i], r.at[2][i], r.at[3][i]);
  })
  return r;
}

/// Stores the first `runs` (1..4) groups of four records: the inverse of load_runs.
PLIANT_HD void store_runs(Record* base, const std::int32_t* run, const Registers& r, int runs) {
  std::memcpy(static_cast<void*>(base + run[0]), r.at[0], sizeof r.at[0]);
  if (runs > 1) std::memcpy(static_cast<void*>(base + run[1]), r.at[1], sizeof r.at[1]);
  if (runs > 2) std::memcpy(static_cast<void*>(base + run[2]), r.at[2], sizeof r.at[2]);
  if (runs > 3) std::memcpy(static_cast<void*>(base + run[3]), r.at[3], sizeof r.at[3]);
}

template <int part>
PLIANT_HD Quad quad_of(const Part& a) {
#if PLIANT_PART_WIDTH == 4
  static_assert(part == 0);
  return a;
#else
  return __builtin_shufflevector(a, a, 4 * part, 4 * part + 1, 4 * part + 2, 4 * part + 3);
#endif
}

PLIANT_HD void store_quad(Record* to, const Quad& q) { std::memcpy(static_cast<void*>(to), &q, sizeof q); }

/// Stores sixteen records by index: the inverse of load_indexed.
PLIANT_HD void store_indexed(Record* base, const std::int32_t* index, const Registers& r) {
#if PLIANT_PART_WIDTH == 16
#define PLIANT_QUAD(j, quad) quad_of<quad>(r.at[j][0])
#elif PLIANT_PART_WIDTH == 8
#define PLIANT_QUAD(j, quad) quad_of<(quad) % 2>(r.at[j][(quad) / 2])
#else
#define PLIANT_QUAD(j, quad) quad_of<0>(r.at[j][quad])
#endif
#define PLIANT_STORE_QUAD(j, quad) store_quad(base + index[4 * (quad) + (j)], PLIANT_QUAD(j, quad));
#if PLIANT_WIDE_WIDTH == 16
#define PLIANT_STORE(j)   \
  PLIANT_STORE_QUAD(j, 0) \
  PLIANT_STORE_QUAD(j, 1) \
  PLIANT_STORE_QUAD(j, 2) \
  PLIANT_STORE_QUAD(j, 3)
#elif PLIANT_WIDE_WIDTH == 8
#define PLIANT_STORE(j)   \
  PLIANT_STORE_QUAD(j, 0) \
  PLIANT_STORE_QUAD(j, 1)
#else
#define PLIANT_STORE(j) PLIANT_STORE_QUAD(j, 0)
#endif
  PLIANT_STORE(0)
  PLIANT_STORE(1)
  PLIANT_STORE(2)
  PLIANT_STORE(3)
#undef PLIANT_STORE
#undef PLIANT_STORE_QUAD
#undef PLIANT_QUAD
}

/// Stores the records of the first `lanes` lanes by index; the other lanes are padding.
PLIANT_HD void store_indexed_some(Record* base, const std::int32_t* index, const Registers& r, int lanes) {
  Record records[4][wide_width / 4];
  static_assert(sizeof records == sizeof r);
  std::memcpy(static_cast<void*>(records), &r, sizeof r);
  PLIANT_KEEP_LOOP
  for (int lane = 0; lane < lanes; ++lane) base[index[lane]] = records[lane % 4][lane / 4];
}

}  // namespace PLIANT_ISA
}  // namespace pliant
