#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "solver/sheets/sheet_cycle.h"
#include "solver/sheets/sheet_rows.h"

namespace pliant::sheets {

namespace {

float distance_squared(const Record& a, const Record& b) {
  const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// True if a block is so wide for the distances of its neighbours that places from its first row, rounded, would blur
/// these more than positions do: pieces of a sheet that have flown apart.
bool is_wide_block(const SheetLevel& level, const Record* x, int block) {
  constexpr float many = 512;  // distances of neighbours; a square block is some ten wide
  constexpr int apart = 64;    // rows between those whose neighbours are measured
  const int first = first_of(block), last = last_of(block, level.rows);
  float width = 0, longest = 0;
  for (int i = first; i < last; ++i) width = std::max(width, distance_squared(x[i], x[first]));
  for (int i = first; i < last; i += apart) {
    const std::size_t p = at(level.pattern[at(i)]);
    for (std::int32_t e = level.begin[p]; e < level.outside[p]; ++e)
      longest = std::max(longest, distance_squared(x[i + level.offset[at(e)]], x[i]));
  }
  return width > many * many * longest;
}

/// A polynomial of so many terms is for h^2 K up to so many masses. The second is 0 at 4.
constexpr float most_of_terms[] = {1, 3.5f};

/// The least that D may be for each pattern, in `beyond`: the sum of |K_ij| by a factor.
void set_bounds(const SheetLevel& level, float by, SheetLevelScratch& own) {
  own.beyond.resize(at(level.patterns()));
  for (std::size_t p = 0; p < own.beyond.size(); ++p) {
    float sum = std::fabs(level.diagonal[p]);
    for (std::int32_t e = level.begin[p]; e < level.begin[p + 1]; ++e) sum += std::fabs(level.stiffness[at(e)]);
    own.beyond[p] = by * sum;
  }
}

}  // namespace

int terms_for(const SheetBending& sheet, float h2) {
  const float most = h2 * sheet.stiffness * largest_of_grid;
  return most <= most_of_terms[0] ? 1 : most <= most_of_terms[1] ? 2 : 0;
}

void set_diagonals(const SheetBending& sheet, const Record* positions, SheetScratch& scratch) {
  scratch.levels.resize(sheet.levels.size());
  const SheetLevel& level = sheet.levels.front();
  SheetLevelScratch& own = scratch.levels.front();
  const std::size_t rows = at(level.rows);
  own.mass.resize(rows);
  own.inverse.resize(rows);
  scratch.moved.resize(rows);
  scratch.corrections.resize(rows);
  own.heavy.clear();
  set_bounds(level, scratch.h2 / most_of_terms[at(terms_for(sheet, scratch.h2) - 1)], own);
  for (std::size_t i = 0; i < rows; ++i) {
    own.mass[i] = mass_of(sheet, positions, i);
    const float least = own.beyond[at(level.pattern[i])];
    own.inverse[i] = own.mass[i] > 0 ? 1 / std::max(own.mass[i], least) : 0;
    if (own.mass[i] == 0 || own.mass[i] >= least) continue;
    own.heavy.resize(rows);
    own.heavy[i] = least - own.mass[i];
  }
}

bool keeps_momentum(const SheetScratch& scratch) { return scratch.levels.front().heavy.empty(); }

void add_term(const SheetBending& sheet, BlockLoop loop, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels.front();
  SheetLevelScratch& own = scratch.levels.front();
  own.x.swap(scratch.corrections);
  scratch.corrections.resize(own.x.size());
  const Matrix a = matrix_of(sheet, scratch, 0);
  loop(level.blocks(), [&](int block) {
    for_rows(level, block, [&](auto count, int first, std::size_t p) {
      constexpr int n = decltype(count)::value;
      const auto others = sums_of<n>(a, own.x.data() + first, level.begin[p], level.begin[p + 1]);
      for (int row = 0; row < n; ++row) {
        const std::size_t i = at(first + row);
        const Four x = load(own.x[i]);
        store(x - (others[at(row)] + x * level.diagonal[p]) * (own.inverse[i] * scratch.h2 / 4),
              scratch.corrections[i]);
      }
    });
  });
}

void find_right_hand_side(const SheetBending& sheet, const SheetForces& forces, BlockLoop loop, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels.front();
  SheetLevelScratch& own = scratch.levels.front();
  const Four gravity{forces.gravity.x, forces.gravity.y, forces.gravity.z, 0};
  const Four load_of_all = gravity * (forces.substeps * forces.substeps);
  // Damping resists motion alone: positions count (n h)^2 times, motion h2 times.
  const float all = forces.substeps * forces.h, undamped = all * all, by = forces.substeps * (scratch.h2 / undamped);
  const Record* x = forces.positions;
  const auto motion = [&](std::int32_t i) {
    const Four d = load(forces.displacements[i]);
    return (x[i].w > 0 ? d - gravity : d) * by;
  };
  // Places from the first row of the block: what they lose by rounding is less than what positions of blocks that are
  // not wide have lost.
  scratch.is_wide.resize(at(level.blocks()));
  loop(level.blocks(), [&](int block) {
    scratch.is_wide[at(block)] = is_wide_block(level, x, block) ? 1 : 0;
    const int first = first_of(block);
    for (int i = first; i < last_of(block, level.rows); ++i)
      store((load(x[i]) - load(x[first])) + motion(i), scratch.moved[at(i)]);
  });
  const bool is_polynomial = terms_for(sheet, scratch.h2) > 0;
  Records& out = is_polynomial ? scratch.corrections : own.right;
  const Matrix a{level, level.stiffness.data(), undamped};
  loop(level.blocks(), [&](int block) {
    for_rows(level, block, [&](auto count, int first, std::size_t p) {
      constexpr int n = decltype(count)::value;
      const Record* y = scratch.moved.data() + first;
      const std::int32_t end_inside = scratch.is_wide[at(block)] != 0 ? level.begin[p] : level.outside[p];
      const auto inside = sums_over<n>(a, level.begin[p], end_inside, [&](std::int32_t offset, int row) {
        return load(y[offset + row]) - load(y[row]);
      });
      const auto outside = sums_over<n>(a, end_inside, level.begin[p + 1], [&](std::int32_t offset, int row) {
        const std::int32_t i = first + row, j = i + offset;
        return (load(x[j]) - load(x[i])) + (motion(j) - motion(i));
      });
      for (int row = 0; row < n; ++row) {
        const std::size_t i = at(first + row);
        const Four r = load_of_all * own.mass[i] - (inside[at(row)] + outside[at(row)]) * undamped;
        store(own.inverse[i] == 0 ? Four{} : is_polynomial ? r * own.inverse[i] : r, out[i]);
      }
    });
  });
}

}  // namespace pliant::sheets
