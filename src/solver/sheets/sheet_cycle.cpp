#include "solver/sheets/sheet_cycle.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "solver/sheets/sheet_rows.h"

namespace pliant::sheets {

namespace {

/// How much heavier a particle is for coarse levels that has become a pin.
constexpr float weight_of_pins = 1e4f;

/// The first entry below a row that is near it.
std::int32_t near_below(const SheetLevel& level, std::size_t p) {
  std::int32_t e = level.above[p];
  while (e > level.begin[p] && level.offset[at(e - 1)] > -abreast) --e;
  return e;
}
/// The first entry above a row that is not near it.
std::int32_t far_above(const SheetLevel& level, std::size_t p) {
  std::int32_t e = level.above[p];
  while (e < level.outside[p] && level.offset[at(e)] < abreast) ++e;
  return e;
}

/// Gauss-Seidel upwards from zero: (D + L) x = r within the block.
void sweep_up(const Matrix& a, int block, SheetLevelScratch& own) {
  const SheetLevel& level = a.level;
  for_rows(level, block, [&](auto count, int first, std::size_t p) {
    constexpr int n = decltype(count)::value;
    const std::int32_t near = near_below(level, p);
    const auto far = sums_of<n>(a, own.x.data() + first, level.begin[p], near);
    for (int row = 0; row < n; ++row) {
      const int i = first + row;
      const float inverse = own.inverse[at(i)], by = a.scale * inverse;
      Four value = load(own.right[at(i)]) * inverse - far[at(row)] * by;
      for (std::int32_t e = near; e < level.above[p]; ++e)
        value -= load(own.x[at(i + level.offset[at(e)])]) * (a.entries[e] * by);
      store(value, own.x[at(i)]);
    }
  });
}

/// What is left of the right-hand side after sweep_up, in `before`.
void find_residual(const Matrix& a, int block, SheetLevelScratch& own) {
  const SheetLevel& level = a.level;
  for_rows(level, block, [&](auto count, int i, std::size_t p) {
    constexpr int n = decltype(count)::value;
    const auto others = sums_of<n>(a, own.x.data() + i, level.above[p], level.begin[p + 1]);
    for (int row = 0; row < n; ++row) {
      const Four left = load(own.x[at(i + row)]) * own.beyond[p] - others[at(row)] * a.scale;
      store(own.inverse[at(i + row)] == 0 ? Four{} : left, own.before[at(i + row)]);
    }
  });
}

/// The right-hand side of the coarser level: the transpose of the interpolation.
void restrict_to(const SheetLevel& level, const SheetLevelScratch& own, int block, SheetLevelScratch& coarse) {
  const int rows = static_cast<int>(level.child_begin.size()) - 1;
  for (int i = first_of(block); i < last_of(block, rows); ++i) {
    Four sum{};
    for (std::int32_t e = level.child_begin[at(i)]; e < level.child_begin[at(i) + 1]; ++e)
      sum += load(own.before[at(level.child[at(e)])]) * level.child_share[at(e)];
    store(sum, coarse.right[at(i)]);
  }
}

/// Adds what the coarser level has found; `before` gets a copy.
void interpolate(const SheetLevel& level, const SheetLevelScratch& coarse, int block, SheetLevelScratch& own) {
  for (int i = first_of(block); i < last_of(block, level.rows); ++i) {
    Four x = load(own.x[at(i)]);
    if (own.inverse[at(i)] != 0)
      for (std::size_t p = 0; p < 3; ++p) x += load(coarse.x[at(level.parent[at(i)][p])]) * level.share[at(i)][p];
    store(x, own.x[at(i)]);
    store(x, own.before[at(i)]);
  }
}

/// Gauss-Seidel downwards: rows of the block have their new values above, those of other blocks the values of before.
void sweep_down(const Matrix& a, int block, SheetLevelScratch& own) {
  const SheetLevel& level = a.level;
  for_rows_down(level, block, [&](auto count, int first, std::size_t p) {
    constexpr int n = decltype(count)::value;
    const std::int32_t above = level.above[p], far = far_above(level, p), outside = level.outside[p];
    const Record* x = own.x.data() + first;
    const auto old = sums_of<n>(a, x, level.begin[p], above), found = sums_of<n>(a, x, far, outside);
    const auto others = sums_of<n>(a, own.before.data() + first, outside, level.begin[p + 1]);
    for (int row = n; row-- > 0;) {
      const int i = first + row;
      const float inverse = own.inverse[at(i)], by = a.scale * inverse;
      const Four all = old[at(row)] + found[at(row)] + others[at(row)];
      Four value = (load(own.right[at(i)]) + load(own.x[at(i)]) * own.beyond[p]) * inverse - all * by;
      for (std::int32_t e = far; e-- > above;) value -= load(own.x[at(i + level.offset[at(e)])]) * (a.entries[e] * by);
      store(value, own.x[at(i)]);
    }
  });
}

/// Solves the last level by its factor.
void solve_directly(const SheetLevel& level, const std::vector<double>& factor, SheetLevelScratch& own) {
  const std::size_t n = at(level.rows);
  double x[3][coarsest_sheet_rows];
  for (std::size_t i = 0; i < n; ++i) {
    const Record& r = own.right[i];
    double sum[3] = {static_cast<double>(r.x), static_cast<double>(r.y), static_cast<double>(r.z)};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < i; ++k) sum[c] -= factor[i * n + k] * x[c][k];
      x[c][i] = own.inverse[i] == 0 ? 0 : sum[c] * factor[i * n + i];  // nothing moves what is fixed
    }
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) x[c][i] -= factor[k * n + i] * x[c][k];
      x[c][i] *= factor[i * n + i];
    }
  for (std::size_t i = 0; i < n; ++i)
    own.x[i] = {static_cast<float>(x[0][i]), static_cast<float>(x[1][i]), static_cast<float>(x[2][i]), 0};
}

bool is_direct(const SheetLevel& level) { return level.rows <= coarsest_sheet_rows; }

void cycle(const SheetBending& sheet, std::size_t l, BlockLoop loop, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels[l];
  SheetLevelScratch& own = scratch.levels[l];
  const Matrix a = matrix_of(sheet, scratch, l);
  const bool is_last = l + 1 == sheet.levels.size();
  if (is_last && is_direct(level)) return solve_directly(level, scratch.factor, own);
  loop(level.blocks(), [&](int block) { sweep_up(a, block, own); });
  if (is_last) {
    own.before = own.x;
  } else {
    SheetLevelScratch& coarse = scratch.levels[l + 1];
    loop(level.blocks(), [&](int block) { find_residual(a, block, own); });
    loop(sheet.levels[l + 1].blocks(), [&](int block) { restrict_to(level, own, block, coarse); });
    cycle(sheet, l + 1, loop, scratch);
    loop(level.blocks(), [&](int block) { interpolate(level, coarse, block, own); });
  }
  loop(level.blocks(), [&](int block) { sweep_down(a, block, own); });
}

/// The scalar product of two arrays: by blocks, then over blocks in order, so threads change no bit.
double product_of(const SheetLevel& level, const Records& a, const Records& b, BlockLoop loop,
                  std::vector<double>& sums) {
  sums.assign(at(level.blocks()), 0);
  loop(level.blocks(), [&](int block) {
    double sum = 0;
    for (int i = first_of(block); i < last_of(block, level.rows); ++i) {
      const Record &p = a[at(i)], &q = b[at(i)];
      sum += static_cast<double>(p.x) * static_cast<double>(q.x) + static_cast<double>(p.y) * static_cast<double>(q.y) +
             static_cast<double>(p.z) * static_cast<double>(q.z);
    }
    sums[at(block)] = sum;
  });
  double sum = 0;
  for (const double one : sums) sum += one;
  return sum;
}

/// product = (M + h^2 K) direction.
void multiply(const Matrix& a, int block, SheetScratch& scratch) {
  const SheetLevel& level = a.level;
  const SheetLevelScratch& own = scratch.levels.front();
  for_rows(level, block, [&](auto count, int first, std::size_t p) {
    constexpr int n = decltype(count)::value;
    const auto others = sums_of<n>(a, scratch.direction.data() + first, level.begin[p], level.begin[p + 1]);
    for (int row = 0; row < n; ++row) {
      const std::size_t i = at(first + row);
      const Four c = load(scratch.direction[i]);
      const Four product = c * (own.mass[i] + own.heavy[i]) + (others[at(row)] + c * level.diagonal[p]) * scratch.h2;
      store(own.inverse[i] == 0 ? Four{} : product, scratch.product[i]);
    }
  });
}

/// to += by * from.
void add(const SheetLevel& level, int block, float by, const Records& from, Records& to) {
  for (int i = first_of(block); i < last_of(block, level.rows); ++i)
    store(load(to[at(i)]) + load(from[at(i)]) * by, to[at(i)]);
}

/// direction = x + by * direction.
void turn(const SheetLevel& level, int block, float by, SheetScratch& scratch) {
  for (int i = first_of(block); i < last_of(block, level.rows); ++i)
    store(load(scratch.levels.front().x[at(i)]) + load(scratch.direction[at(i)]) * by, scratch.direction[at(i)]);
}

/// Conjugate gradients with the cycle as preconditioner.
void iterate(const SheetBending& sheet, int cycles, BlockLoop loop, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels.front();
  SheetLevelScratch& own = scratch.levels.front();
  scratch.direction.assign(own.x.size(), {});
  scratch.product.resize(own.x.size());
  scratch.corrections.assign(own.x.size(), {});
  double before = 0;
  for (int made = 0; made < cycles; ++made) {
    cycle(sheet, 0, loop, scratch);
    const double now = product_of(level, own.right, own.x, loop, scratch.sums);
    const auto beta = static_cast<float>(before > 0 ? now / before : 0);
    before = now;
    loop(level.blocks(), [&](int block) { turn(level, block, beta, scratch); });
    loop(level.blocks(), [&](int block) { multiply(matrix_of(sheet, scratch, 0), block, scratch); });
    const double stiff = product_of(level, scratch.direction, scratch.product, loop, scratch.sums);
    if (!(stiff > 0)) return;
    const auto alpha = static_cast<float>(now / stiff);
    loop(level.blocks(), [&](int block) {
      add(level, block, alpha, scratch.direction, scratch.corrections);
      add(level, block, -alpha, scratch.product, own.right);
    });
  }
}

/// Lumps what each row has onto the coarser level: the sum of the absolute values of a row of the Galerkin product,
/// which is stiffer.
void lump(const SheetLevel& level, const std::vector<float>& from, std::vector<float>& to) {
  for (std::size_t i = 0; i + 1 < level.child_begin.size(); ++i) {
    float sum = 0;
    for (std::int32_t e = level.child_begin[i]; e < level.child_begin[i + 1]; ++e) {
      const std::size_t child = at(level.child[at(e)]);
      if (from[child] == 0) continue;
      float shares = 0;
      for (const float share : level.share[child]) shares += std::fabs(share);
      sum += std::fabs(level.child_share[at(e)]) * shares * from[child];
    }
    to[i] = sum;
  }
}

/// Coarse levels: entries and what they have beyond their blocks. The finest one has its stiffness alone.
void set_entries(const SheetBending& sheet, std::size_t l, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels[l];
  SheetLevelScratch& own = scratch.levels[l];
  if (l > 0) {
    own.entries.resize(level.stiffness.size());
    for (std::size_t e = 0; e < own.entries.size(); ++e)
      own.entries[e] = level.mass_between[e] + scratch.h2 * level.stiffness[e];
  }
  const Matrix a = matrix_of(sheet, scratch, l);
  own.beyond.resize(at(level.patterns()));
  for (std::size_t p = 0; p < own.beyond.size(); ++p) {
    float sum = 0;
    for (std::int32_t e = level.outside[p]; e < level.begin[p + 1]; ++e) sum += std::fabs(a.entries[e]);
    own.beyond[p] = a.scale * sum;
  }
}

/// The Cholesky factor of the last level.
void factorise_last(const SheetLevel& last, const SheetLevelScratch& own, float h2, std::vector<double>& a) {
  const std::size_t n = at(last.rows);
  a.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    a[i * n + i] = 1;
    if (own.inverse[i] == 0) continue;
    const std::size_t p = at(last.pattern[i]);
    a[i * n + i] = static_cast<double>(own.mass[i] + own.heavy[i] + h2 * last.diagonal[p]);
    for (std::int32_t e = last.begin[p]; e < last.begin[p + 1]; ++e) {
      const std::size_t j = at(static_cast<int>(i) + last.offset[at(e)]);
      const float mass = last.mass_between.empty() ? 0 : last.mass_between[at(e)];
      if (own.inverse[j] != 0) a[i * n + j] = static_cast<double>(mass + h2 * last.stiffness[at(e)]);
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k)
      for (std::size_t i = j; i < n; ++i) a[i * n + j] -= a[i * n + k] * a[j * n + k];
    const double pivot = a[j * n + j];
    const double root = 1 / std::sqrt(pivot > 1e-30 ? pivot : 1e-30);
    for (std::size_t i = j + 1; i < n; ++i) a[i * n + j] *= root;
    a[j * n + j] = root;  // the inverse of the factor's diagonal
  }
}

}  // namespace

void set_masses(const SheetBending& sheet, const Record* positions, SheetScratch& scratch) {
  scratch.levels.resize(sheet.levels.size());
  std::vector<float> added;  // on the finest level: what masses have become more than were given, by water or as pins
  for (std::size_t l = 0; l < sheet.levels.size(); ++l) {
    const SheetLevel& level = sheet.levels[l];
    SheetLevelScratch& own = scratch.levels[l];
    const std::size_t rows = at(level.rows);
    own.mass = level.mass;
    own.inverse.resize(rows);
    own.heavy.assign(rows, 0);
    for (Records* r : {&own.right, &own.x, &own.before}) r->resize(rows);
    if (l == 1) lump(sheet.levels[0], added, own.heavy);
    if (l > 1) lump(sheet.levels[l - 1], scratch.levels[l - 1].heavy, own.heavy);
    if (l > 0) continue;
    added.assign(rows, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      const float now = mass_of(sheet, positions, i);
      added[i] = std::max((now > 0 ? now : weight_of_pins * own.mass[i]) - own.mass[i], 0.f);
      own.mass[i] = now;
    }
  }
  scratch.moved.resize(scratch.levels.front().mass.size());
  scratch.corrections.resize(scratch.moved.size());
  for (std::size_t l = 0; l < sheet.levels.size(); ++l) set_entries(sheet, l, scratch);
}

void factorise(const SheetBending& sheet, SheetScratch& scratch) {
  for (std::size_t l = 0; l < sheet.levels.size(); ++l) {
    const SheetLevel& level = sheet.levels[l];
    SheetLevelScratch& own = scratch.levels[l];
    for (std::size_t i = 0; i < own.inverse.size(); ++i) {
      const std::size_t p = at(level.pattern[i]);
      const float sum = own.mass[i] + own.heavy[i] + scratch.h2 * level.diagonal[p] + own.beyond[p];
      const bool is_free = own.mass[i] > 0 && (l == 0 || level.is_fixed[i] == 0);  // pins may have been released
      own.inverse[i] = is_free ? 1 / sum : 0;
    }
  }
  if (is_direct(sheet.levels.back()))
    factorise_last(sheet.levels.back(), scratch.levels.back(), scratch.h2, scratch.factor);
}

void solve_sheet(const SheetBending& sheet, int cycles, BlockLoop loop, SheetScratch& scratch) {
  if (cycles > 1) return iterate(sheet, cycles, loop, scratch);
  cycle(sheet, 0, loop, scratch);
  scratch.corrections.swap(scratch.levels.front().x);
}

}  // namespace pliant::sheets
