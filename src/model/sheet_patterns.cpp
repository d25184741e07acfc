// Rows of a sheet's matrices that differ by rounding alone share one pattern (model/sheet_bending.h).
//
// A pattern is the first of its rows. Rows of a lattice differ by the rounding of masses alone, because
// model/sheet_lattice.h undoes that of rest positions. Else the rounding of the first row, up to 1e-5 of K_ii an edge,
// would pull all others aside (docs/internals/bending.md).
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/at.h"
#include "model/sheet_bending.h"

namespace pliant {

namespace {

/// How far entries of one pattern may differ, over the diagonal: of K, and of M, whose rows have rounded masses.
constexpr double most_rounding = 1e-9, most_of_masses = 1e-5;

/// A row whose entries are in the order of a pattern.
struct OrderedRow {
  std::vector<std::int32_t> offset;
  std::vector<double> stiffness, mass;
  std::array<std::int32_t, 2> parts{};  ///< where the columns above the row begin, and those of other blocks
  double diagonal = 0, own_mass = 0;
};

/// Which part of a row an entry belongs to: 0 below the row in its block, 1 above it, 2 in other blocks.
int part_of(int row, int column) {
  if (row / sheet_block != column / sheet_block) return 2;
  return column < row ? 0 : 1;
}

void order_row(const std::vector<SparseRows::Entry>& entries, int row, OrderedRow& out) {
  out.offset.clear();
  out.stiffness.clear();
  out.mass.clear();
  out.diagonal = out.own_mass = 0;  // what no hinge reaches has no entry of its own
  for (int part = 0; part < 3; ++part) {
    if (part > 0) out.parts[at(part - 1)] = static_cast<std::int32_t>(out.offset.size());
    for (const auto& [j, stiffness, mass] : entries) {
      if (j == row) out.diagonal = stiffness;
      if (j == row) out.own_mass = mass;
      if (j == row || part_of(row, j) != part) continue;
      out.offset.push_back(j - row);
      out.stiffness.push_back(stiffness);
      out.mass.push_back(mass);
    }
  }
}

/// The patterns found so far, and chains of those whose offsets have the same hash.
class PatternTable {
 public:
  PatternTable(std::size_t rows, bool of_masses, SheetLevel& level) : of_masses_(of_masses), level_(level) {
    std::size_t size = 64;
    while (size < rows) size *= 2;
    newest_.assign(size, -1);
    level_.begin.push_back(0);
  }

  int find_or_append(const OrderedRow& row) {
    std::uint64_t hash = static_cast<std::uint64_t>(row.parts[0]) * 64 + static_cast<std::uint64_t>(row.parts[1]);
    for (const std::int32_t o : row.offset) hash = (hash ^ static_cast<std::uint32_t>(o)) * 0x9e3779b97f4a7c15u;
    std::int32_t& newest = newest_[(hash >> 20) & (newest_.size() - 1)];
    for (std::int32_t p = newest; p >= 0; p = next_[at(p)])
      if (is_like(row, p)) return p;
    append(row);
    next_.push_back(newest);
    newest = level_.patterns() - 1;
    return newest;
  }

 private:
  struct Values {
    double stiffness = 0, mass = 0;
  };

  bool is_like(const OrderedRow& row, std::int32_t p) const {
    const auto begin = at(level_.begin[at(p)]);
    if (at(level_.begin[at(p) + 1]) - begin != row.offset.size()) return false;
    if (level_.above[at(p)] - level_.begin[at(p)] != row.parts[0]) return false;
    if (level_.outside[at(p)] - level_.begin[at(p)] != row.parts[1]) return false;
    const double most = most_rounding * std::fabs(row.diagonal), most_mass = most_of_masses * std::fabs(row.own_mass);
    if (std::fabs(diagonals_[at(p)] - row.diagonal) > most) return false;
    for (std::size_t k = 0; k < row.offset.size(); ++k) {
      const Values& value = values_[begin + k];
      if (level_.offset[begin + k] != row.offset[k] || std::fabs(value.stiffness - row.stiffness[k]) > most)
        return false;
      if (of_masses_ && std::fabs(value.mass - row.mass[k]) > most_mass) return false;
    }
    return true;
  }

  void append(const OrderedRow& row) {
    level_.above.push_back(level_.begin.back() + row.parts[0]);
    level_.outside.push_back(level_.begin.back() + row.parts[1]);
    level_.offset.insert(level_.offset.end(), row.offset.begin(), row.offset.end());
    level_.begin.push_back(static_cast<std::int32_t>(level_.offset.size()));
    diagonals_.push_back(row.diagonal);
    double sum = 0;
    for (std::size_t k = 0; k < row.offset.size(); ++k) {
      values_.push_back({row.stiffness[k], row.mass[k]});
      level_.stiffness.push_back(static_cast<float>(row.stiffness[k]));
      sum += static_cast<double>(level_.stiffness.back());
      if (of_masses_) level_.mass_between.push_back(static_cast<float>(row.mass[k]));
    }
    // On the finest level the diagonal is less the sum of the others. It is that of the rounded ones, since all rows of
    // the pattern would have the same error.
    level_.diagonal.push_back(static_cast<float>(of_masses_ || row.offset.empty() ? row.diagonal : -sum));
  }

  bool of_masses_;
  SheetLevel& level_;
  std::vector<std::int32_t> newest_, next_;
  std::vector<Values> values_;     // of each entry
  std::vector<double> diagonals_;  // of each pattern
};

}  // namespace

void append_patterns(const SparseRows& matrix, bool of_masses, SheetLevel& level) {
  PatternTable table(matrix.row.size(), of_masses, level);
  level.pattern.reserve(matrix.row.size());
  OrderedRow row;
  for (std::size_t i = 0; i < matrix.row.size(); ++i) {
    order_row(matrix.row[i], static_cast<int>(i), row);
    level.pattern.push_back(table.find_or_append(row));
  }
}

}  // namespace pliant
