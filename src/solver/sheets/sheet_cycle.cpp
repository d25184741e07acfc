#include "solver/sheets/sheet_cycle.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/at.h"

namespace pliant {

namespace {

/// How much heavier a particle is for coarse levels that has become a pin.
constexpr float weight_of_pins = 1e4f;

/// A record as four floats: x, y, z, w side by side, in the compiler's own vector type.
typedef float Four __attribute__((vector_size(16)));

Four load(const Record& r) {
  Four out;
  std::memcpy(&out, &r, sizeof out);
  return out;
}
void store(const Four& value, Record& r) { std::memcpy(static_cast<void*>(&r), &value, sizeof value); }

/// A level's matrix beside its diagonal: `scale` times `entries`.
struct Matrix {
  const SheetLevel& level;
  const float* entries = nullptr;
  float scale = 1;
};

Matrix matrix_of(const SheetBending& sheet, const SheetScratch& scratch, std::size_t l) {
  if (l == 0) return {sheet.levels[0], sheet.levels[0].stiffness.data(), scratch.h2};
  return {sheet.levels[l], scratch.levels[l].entries.data(), 1};
}

/// The sum of a_ij x_j over entries [first, last), less the scale: of two sums, since an addition waits for the one
/// before.
Four sum_of(const Matrix& a, const Record* x, std::int32_t first, std::int32_t last) {
  Four even{}, odd{};
  const float* k = a.entries;
  const std::int32_t* column = a.level.column.data();
  std::int32_t e = first;
  for (; e + 1 < last; e += 2) {
    even += load(x[column[e]]) * k[e];
    odd += load(x[column[e + 1]]) * k[e + 1];
  }
  if (e < last) even += load(x[column[e]]) * k[e];
  return even + odd;
}

int first_of(int block) { return block * sheet_block; }
int last_of(int block, int rows) { return std::min(rows, (block + 1) * sheet_block); }

/// Gauss-Seidel upwards from zero: (D + L) x = r within the block.
void sweep_up(const Matrix& a, int block, SheetLevelScratch& own) {
  for (int i = first_of(block); i < last_of(block, a.level.rows); ++i) {
    const Four below = sum_of(a, own.x.data(), a.level.begin[at(i)], a.level.above[at(i)]);
    store((load(own.right[at(i)]) - below * a.scale) * own.inverse[at(i)], own.x[at(i)]);
  }
}

/// What is left of the right-hand side after sweep_up, in `before`.
void find_residual(const Matrix& a, int block, SheetLevelScratch& own) {
  for (int i = first_of(block); i < last_of(block, a.level.rows); ++i) {
    const Four others = sum_of(a, own.x.data(), a.level.above[at(i)], a.level.begin[at(i) + 1]);
    const Four left = load(own.x[at(i)]) * own.beyond[at(i)] - others * a.scale;
    store(own.inverse[at(i)] == 0 ? Four{} : left, own.before[at(i)]);
  }
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
  for (int i = last_of(block, a.level.rows); i-- > first_of(block);) {
    const Four inside = sum_of(a, own.x.data(), a.level.begin[at(i)], a.level.outside[at(i)]);
    const Four outside = sum_of(a, own.before.data(), a.level.outside[at(i)], a.level.begin[at(i) + 1]);
    const Four right = load(own.right[at(i)]) - (inside + outside) * a.scale + load(own.x[at(i)]) * own.beyond[at(i)];
    store(right * own.inverse[at(i)], own.x[at(i)]);
  }
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
double product_of(const SheetLevel& level, const Records& a, const Records& b, BlockLoop loop, std::vector<double>& sums) {
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
  for (int i = first_of(block); i < last_of(block, level.rows); ++i) {
    const Four c = load(scratch.direction[at(i)]);
    const Four others = sum_of(a, scratch.direction.data(), level.begin[at(i)], level.begin[at(i) + 1]);
    const Four product = c * (own.mass[at(i)] + own.heavy[at(i)]) + (others + c * level.diagonal[at(i)]) * scratch.h2;
    store(own.inverse[at(i)] == 0 ? Four{} : product, scratch.product[at(i)]);
  }
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
  for (std::size_t i = 0; i < own.beyond.size(); ++i) {
    float sum = 0;
    for (std::int32_t e = level.outside[i]; e < level.begin[i + 1]; ++e) sum += std::fabs(a.entries[e]);
    own.beyond[i] = a.scale * sum;
  }
}

/// The Cholesky factor of the last level.
void factorise_last(const SheetLevel& last, const SheetLevelScratch& own, float h2, std::vector<double>& a) {
  const std::size_t n = at(last.rows);
  a.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    a[i * n + i] = 1;
    if (own.inverse[i] == 0) continue;
    a[i * n + i] = static_cast<double>(own.mass[i] + own.heavy[i] + h2 * last.diagonal[i]);
    for (std::int32_t e = last.begin[i]; e < last.begin[i + 1]; ++e) {
      const std::size_t j = at(last.column[at(e)]);
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
    own.beyond.resize(rows);
    own.heavy.assign(rows, 0);
    for (Records* r : {&own.right, &own.x, &own.before}) r->resize(rows);
    if (l == 1) lump(sheet.levels[0], added, own.heavy);
    if (l > 1) lump(sheet.levels[l - 1], scratch.levels[l - 1].heavy, own.heavy);
    if (l > 0) continue;
    added.assign(rows, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      const bool is_free = positions[i].w > 0 && (sheet.is_held.empty() || sheet.is_held[i] == 0);
      const float now = is_free ? 1 / positions[i].w : weight_of_pins * own.mass[i];
      added[i] = std::max(now - own.mass[i], 0.f);
      own.mass[i] = is_free ? now : 0;
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
      const float sum = own.mass[i] + own.heavy[i] + scratch.h2 * level.diagonal[i] + own.beyond[i];
      const bool is_free = own.mass[i] > 0 && (l == 0 || level.is_fixed[i] == 0);  // pins may have been released
      own.inverse[i] = is_free ? 1 / sum : 0;
    }
  }
  if (is_direct(sheet.levels.back()))
    factorise_last(sheet.levels.back(), scratch.levels.back(), scratch.h2, scratch.factor);
}

void find_right_hand_side(const SheetBending& sheet, const SheetForces& forces, BlockLoop loop, SheetScratch& scratch) {
  const SheetLevel& level = sheet.levels.front();
  SheetLevelScratch& own = scratch.levels.front();
  const Four gravity{forces.gravity.x, forces.gravity.y, forces.gravity.z, 0};
  const Four load_of_all = gravity * (forces.substeps * forces.substeps);
  const float all = forces.substeps * forces.h, undamped = all * all / scratch.h2;  // damping resists motion alone
  loop(level.blocks(), [&](int block) {
    for (int i = first_of(block); i < last_of(block, level.rows); ++i) {
      const bool falls = forces.positions[i].w > 0;
      const Four d = load(forces.displacements[i]);
      store(falls ? d - gravity : d, scratch.moved[at(i)]);
    }
  });
  loop(level.blocks(), [&](int block) {
    for (int i = first_of(block); i < last_of(block, level.rows); ++i) {
      const Four x = load(forces.positions[i]), u = load(scratch.moved[at(i)]);
      const auto term = [&](std::int32_t e) {
        const std::size_t j = at(level.column[at(e)]);
        const Four place = load(forces.positions[j]) - x, motion = load(scratch.moved[j]) - u;
        return (place * undamped + motion * forces.substeps) * level.stiffness[at(e)];
      };
      Four even{}, odd{};
      std::int32_t e = level.begin[at(i)];
      const std::int32_t last = level.begin[at(i) + 1];
      for (; e + 1 < last; e += 2) {
        even += term(e);
        odd += term(e + 1);
      }
      if (e < last) even += term(e);
      const Four r = load_of_all * own.mass[at(i)] - (even + odd) * scratch.h2;
      store(own.inverse[at(i)] == 0 ? Four{} : r, own.right[at(i)]);
    }
  });
}

void solve_sheet(const SheetBending& sheet, int cycles, BlockLoop loop, SheetScratch& scratch) {
  if (cycles > 1) return iterate(sheet, cycles, loop, scratch);
  cycle(sheet, 0, loop, scratch);
  scratch.corrections.swap(scratch.levels.front().x);
}

}  // namespace pliant
