// The rows of a sheet's matrices in loops, four side by side where they share a pattern (model/sheet_bending.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "core/at.h"
#include "solver/sheets/sheet_solver.h"

namespace pliant::sheets {

/// A record as four floats: x, y, z, w side by side, in the compiler's own vector type.
typedef float Four __attribute__((vector_size(16)));

inline Four load(const Record& r) {
  Four out;
  std::memcpy(&out, &r, sizeof out);
  return out;
}
inline void store(const Four& value, Record& r) { std::memcpy(static_cast<void*>(&r), &value, sizeof value); }

/// The mass of a particle; 0 if it is pinned or held [kg].
inline float mass_of(const SheetBending& sheet, const Record* positions, std::size_t i) {
  const bool is_free = positions[i].w > 0 && (sheet.is_held.empty() || sheet.is_held[i] == 0);
  return is_free ? 1 / positions[i].w : 0;
}

/// A level's matrix beside its diagonal: `scale` times `entries`.
struct Matrix {
  const SheetLevel& level;
  const float* entries = nullptr;
  float scale = 1;
};

inline Matrix matrix_of(const SheetBending& sheet, const SheetScratch& scratch, std::size_t l) {
  if (l == 0) return {sheet.levels[0], sheet.levels[0].stiffness.data(), scratch.h2};
  return {sheet.levels[l], scratch.levels[l].entries.data(), 1};
}

/// The sums of a_ij term(j - i, row) over entries [first, last) of a pattern, less the scale, for `n` rows that share
/// it: of two sums each, since an addition waits for the one before. Rows side by side change no bit.
template <int n, class Term>
[[gnu::always_inline]] inline std::array<Four, n> sums_over(const Matrix& a, std::int32_t first, std::int32_t last,
                                                            const Term& term) {
  std::array<Four, n> even{}, odd{};
  const float* k = a.entries;
  const std::int32_t* offset = a.level.offset.data();
  std::int32_t e = first;
  for (; e + 1 < last; e += 2)
    for (int row = 0; row < n; ++row) {
      even[at(row)] += term(offset[e], row) * k[e];
      odd[at(row)] += term(offset[e + 1], row) * k[e + 1];
    }
  for (int row = 0; row < n; ++row) {
    if (e < last) even[at(row)] += term(offset[e], row) * k[e];
    even[at(row)] += odd[at(row)];
  }
  return even;
}

/// The same of a_ij x_j. `x`: the value of the first row.
template <int n>
[[gnu::always_inline]] inline std::array<Four, n> sums_of(const Matrix& a, const Record* x, std::int32_t first,
                                                          std::int32_t last) {
  return sums_over<n>(a, first, last, [&](std::int32_t offset, int row) { return load(x[offset + row]); });
}

inline int first_of(int block) { return block * sheet_block; }
inline int last_of(int block, int rows) { return std::min(rows, (block + 1) * sheet_block); }

/// So many rows of one pattern are processed at a time, which loads each entry once. Gauss-Seidel handles entries
/// between these rows last, one row after another; storage seldom puts neighbours so near (topology/numbering.h).
inline constexpr int abreast = 4;

/// True if `abreast` rows from `i` on share a pattern.
inline bool are_alike(const SheetLevel& level, int i) {
  const std::int32_t* p = level.pattern.data() + i;
  return p[1] == p[0] && p[2] == p[0] && p[3] == p[0];
}

/// Calls body(count, row, pattern) for rows [row, row + count), which share a pattern. `count` is a constant: `abreast`
/// or one.
template <class Body>
void call_for(const SheetLevel& level, int count, int row, const Body& body) {
  const std::size_t p = at(level.pattern[at(row)]);
  if (count == abreast) return body(std::integral_constant<int, abreast>(), row, p);
  body(std::integral_constant<int, 1>(), row, p);
}

/// Calls it for all rows of a block.
template <class Body>
void for_rows(const SheetLevel& level, int block, const Body& body) {
  const int last = last_of(block, level.rows);
  for (int i = first_of(block), count = 0; i < last; i += count) {
    count = i + abreast <= last && are_alike(level, i) ? abreast : 1;
    call_for(level, count, i, body);
  }
}

/// The same from the last row to the first.
template <class Body>
void for_rows_down(const SheetLevel& level, int block, const Body& body) {
  const int first = first_of(block);
  for (int i = last_of(block, level.rows), count = 0; i > first; i -= count) {
    count = i - abreast >= first && are_alike(level, i - abreast) ? abreast : 1;
    call_for(level, count, i - count, body);
  }
}

}  // namespace pliant::sheets
