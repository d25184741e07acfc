// The levels of a sheet's bending energy (model/sheet_bending.h): coarse vertices, interpolation between them, Galerkin
// products.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/at.h"
#include "math/vector.h"
#include "model/sheet_bending.h"

namespace pliant {

namespace {

/// Coarsening ends where a level keeps more than this share of the rows of the finer one.
constexpr double most_kept = 0.7;
/// Coarse vertices among which the three to interpolate between are sought.
constexpr std::size_t most_candidates = 10;

/// 1 for the vertices that the next level keeps: in the order of rows, those without a kept neighbour.
std::vector<char> kept_rows(const SheetDraft& draft) {
  std::vector<char> is_kept(draft.rest.size(), 0), is_beside(draft.rest.size(), 0);
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (draft.around[i].empty() || is_beside[i] != 0) continue;
    is_kept[i] = 1;
    for (const int j : draft.around[i]) is_beside[at(j)] = 1;
  }
  return is_kept;
}

/// A kept vertex near a row, in the row's tangent plane.
struct Candidate {
  int row = 0;
  double x = 0, z = 0, squared = 0;
};

/// Sorts candidates, nearest first. Those of a lattice are equally near but for rounding: their places decide, so that
/// all rows of a lattice choose alike.
void sort_by_distance(std::vector<Candidate>& all) {
  double largest = 0;
  for (const Candidate& one : all) largest = std::max(largest, one.squared);
  if (!(largest > 0)) return;
  const double length_unit = std::sqrt(largest) * 1e-6;
  const auto whole = [](double value) { return std::floor(value + 0.3); };
  const auto key = [&](const Candidate& c) {
    return std::make_tuple(whole(c.squared / (largest * 1e-6)), whole(c.x / length_unit), whole(c.z / length_unit),
                           c.row);
  };
  std::sort(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
}

/// The kept vertices within two edges of a row, or three where those are few, nearest first.
std::vector<Candidate> candidates_of(const SheetDraft& draft, const std::vector<char>& is_kept, int row,
                                     std::vector<int>& seen) {
  std::vector<int> reached(1, row);
  seen[at(row)] = row;
  std::size_t first = 0;
  const auto kept = [&] {
    return std::count_if(reached.begin(), reached.end(), [&](int j) { return is_kept[at(j)] != 0; });
  };
  for (int ring = 0; ring < 2 || (ring < 3 && kept() < 5); ++ring) {
    const std::size_t last = reached.size();
    for (; first < last; ++first)
      for (const int j : draft.around[at(reached[first])]) {
        if (seen[at(j)] == row) continue;
        seen[at(j)] = row;
        reached.push_back(j);
      }
  }
  const Vec3d n = draft.normal[at(row)], helper = std::fabs(n.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d across = cross(helper, n), u = across * (1 / length(across)), v = cross(n, u);
  std::vector<Candidate> out;
  for (const int j : reached) {
    if (is_kept[at(j)] == 0) continue;  // of both lips of a crack, which have one place, either may be kept
    const Vec3d d = draft.rest[at(j)] - draft.rest[at(row)];
    out.push_back({j, dot(d, u), dot(d, v), length_squared(d)});
  }
  sort_by_distance(out);
  if (out.size() > most_candidates) out.resize(most_candidates);
  return out;
}

/// Three rows and their weights.
struct Interpolation {
  std::array<int, 3> row{};
  std::array<double, 3> weight{};
};

/// Interpolates along the line through two vertices, within it.
Interpolation between(const Candidate& a, const Candidate& b) {
  const double x = b.x - a.x, z = b.z - a.z, squared = x * x + z * z;
  const double share = squared > 0 ? std::clamp(-(a.x * x + a.z * z) / squared, 0.0, 1.0) : 0;
  return {{a.row, b.row, a.row}, {1 - share, share, 0}};
}

/// Linear interpolation by the triangle of vertices that is tightest: it has the least sum of |weight| distance^2, as
/// the triangle of a Delaunay triangulation has.
Interpolation interpolate(const std::vector<Candidate>& all) {
  if (all.empty()) return {};
  if (all.size() == 1 || all[0].squared == 0) return {{all[0].row, all[0].row, all[0].row}, {1, 0, 0}};
  Interpolation best = between(all[0], all[1]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      for (std::size_t c = b + 1; c < all.size(); ++c) {
        const Candidate &p = all[a], &q = all[b], &r = all[c];
        const double twice = (q.x - p.x) * (r.z - p.z) - (r.x - p.x) * (q.z - p.z);
        if (std::fabs(twice) < 0.1 * std::max({p.squared, q.squared, r.squared})) continue;
        const double wp = (q.x * r.z - r.x * q.z) / twice, wq = (r.x * p.z - p.x * r.z) / twice, wr = 1 - wp - wq;
        const double score = std::fabs(wp) * p.squared + std::fabs(wq) * q.squared + std::fabs(wr) * r.squared;
        if (!(score < least * (1 - 1e-9))) continue;
        least = score;
        best = {{p.row, q.row, r.row}, {wp, wq, wr}};
      }
  return best;
}

std::vector<Interpolation> interpolate_all(const SheetDraft& draft, const std::vector<char>& is_kept) {
  std::vector<Interpolation> out(draft.rest.size());
  std::vector<int> seen(draft.rest.size(), -1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (draft.around[i].empty()) continue;
    const int row = static_cast<int>(i);
    out[i] = is_kept[i] != 0 ? Interpolation{{row, row, row}, {1, 0, 0}}
                             : interpolate(candidates_of(draft, is_kept, row, seen));
    for (double& weight : out[i].weight)
      if (std::fabs(weight) < 1e-9) weight = 0;
  }
  return out;
}

/// A row of sparse numbers that is being summed.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : sum_(columns), is_in_(columns, 0) {}
  void add(int column, double stiffness, double mass) {
    if (is_in_[at(column)] == 0) columns_.push_back(column);
    is_in_[at(column)] = 1;
    sum_[at(column)].stiffness += stiffness;
    sum_[at(column)].mass += mass;
  }
  std::vector<SparseRows::Entry> take() {
    std::sort(columns_.begin(), columns_.end());
    std::vector<SparseRows::Entry> row;
    row.reserve(columns_.size());
    for (const int j : columns_) {
      row.push_back({j, sum_[at(j)].stiffness, sum_[at(j)].mass});
      sum_[at(j)] = {};
      is_in_[at(j)] = 0;
    }
    columns_.clear();
    return row;
  }

 private:
  std::vector<SparseRows::Entry> sum_;
  std::vector<char> is_in_;
  std::vector<int> columns_;
};

/// The Galerkin products I^T K I and I^T M I. `number`: the row of the next level of each kept row. Rows that are fixed
/// do not move with coarse ones.
SparseRows product(const SparseRows& k, const std::vector<Interpolation>& by, const std::vector<char>& is_fixed,
                   const std::vector<int>& number, int rows) {
  std::vector<std::vector<std::pair<int, double>>> shares(at(rows));  // of each coarse row: fine rows and weights
  for (std::size_t i = 0; i < by.size(); ++i)
    for (std::size_t p = 0; p < 3; ++p)
      if (by[i].weight[p] != 0 && is_fixed[i] == 0)
        shares[at(number[at(by[i].row[p])])].push_back({static_cast<int>(i), by[i].weight[p]});
  SparseRows out;
  out.row.reserve(at(rows));
  RowSum sum(at(rows));
  for (int coarse = 0; coarse < rows; ++coarse) {
    for (const auto& [i, share] : shares[at(coarse)])
      for (const auto& [j, stiffness, mass] : k.row[at(i)]) {
        if (is_fixed[at(j)] != 0) continue;
        for (std::size_t p = 0; p < 3; ++p) {
          const double both = share * by[at(j)].weight[p];
          if (both != 0) sum.add(number[at(by[at(j)].row[p])], both * stiffness, both * mass);
        }
      }
    out.row.push_back(sum.take());
  }
  return out;
}

/// Joins coarse rows between which a row is interpolated; what is left alone, as a corner may be, to all rows that it
/// acts on.
std::vector<std::vector<int>> joined(const std::vector<Interpolation>& by, const std::vector<int>& number,
                                     const SparseRows& matrix) {
  const int rows = static_cast<int>(matrix.row.size());
  std::vector<std::vector<int>> out(at(rows));
  for (const Interpolation& one : by)
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = 0; q < 3; ++q) {
        if (one.weight[p] == 0 || one.weight[q] == 0 || one.row[p] == one.row[q]) continue;
        out[at(number[at(one.row[p])])].push_back(number[at(one.row[q])]);
      }
  for (int i = 0; i < rows; ++i) {
    if (!out[at(i)].empty()) continue;
    for (const SparseRows::Entry& entry : matrix.row[at(i)]) {
      if (entry.column == i) continue;
      out[at(i)].push_back(entry.column);
      out[at(entry.column)].push_back(i);
    }
  }
  for (std::vector<int>& row : out) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return out;
}

/// Lays out the matrices as a level.
SheetLevel lay_out(const SheetDraft& draft, const SparseRows& k, bool is_finest) {
  SheetLevel out;
  out.rows = static_cast<int>(k.row.size());
  out.is_fixed = draft.is_fixed;
  out.mass.assign(at(out.rows), 0);
  for (int i = 0; i < out.rows; ++i)
    for (const SparseRows::Entry& entry : k.row[at(i)])
      if (entry.column == i) out.mass[at(i)] = static_cast<float>(entry.mass);
  append_patterns(k, !is_finest, out);
  return out;
}

void set_parents(const std::vector<Interpolation>& by, const std::vector<char>& is_fixed,
                 const std::vector<int>& number, int rows, SheetLevel& level) {
  std::vector<std::vector<std::pair<int, float>>> children(at(rows));
  for (std::size_t i = 0; i < by.size(); ++i) {
    std::array<std::int32_t, 3> parent{};
    std::array<float, 3> share{};
    for (std::size_t p = 0; p < 3; ++p) {
      if (by[i].weight[p] == 0 || is_fixed[i] != 0) continue;
      parent[p] = number[at(by[i].row[p])];
      share[p] = static_cast<float>(by[i].weight[p]);
      children[at(parent[p])].push_back({static_cast<int>(i), share[p]});
    }
    level.parent.push_back(parent);
    level.share.push_back(share);
  }
  level.child_begin.push_back(0);
  for (const auto& row : children) {
    for (const auto& [i, share] : row) {
      level.child.push_back(i);
      level.child_share.push_back(share);
    }
    level.child_begin.push_back(static_cast<std::int32_t>(level.child.size()));
  }
}

}  // namespace

void append_levels(SheetDraft draft, SparseRows stiffness, std::vector<SheetLevel>& levels) {
  while (true) {
    levels.push_back(lay_out(draft, stiffness, levels.empty()));
    if (levels.back().rows <= coarsest_sheet_rows) return;
    const std::vector<char> is_kept = kept_rows(draft);
    std::vector<int> number(is_kept.size(), -1);
    SheetDraft coarse;
    for (std::size_t i = 0; i < is_kept.size(); ++i) {
      if (is_kept[i] == 0) continue;
      number[i] = static_cast<int>(coarse.rest.size());
      coarse.rest.push_back(draft.rest[i]);
      coarse.normal.push_back(draft.normal[i]);
      coarse.is_fixed.push_back(draft.is_fixed[i]);
    }
    const int rows = static_cast<int>(coarse.rest.size());
    if (rows == 0 || rows > most_kept * levels.back().rows) return;
    const std::vector<Interpolation> by = interpolate_all(draft, is_kept);
    SparseRows next = product(stiffness, by, draft.is_fixed, number, rows);
    coarse.around = joined(by, number, next);
    set_parents(by, draft.is_fixed, number, rows, levels.back());
    draft = std::move(coarse);
    stiffness = std::move(next);
  }
}

}  // namespace pliant
