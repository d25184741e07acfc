// Points in the order of the cells of a grid, so that points that are close in space are close in memory.
//
// Cells are rows along x, one behind another along z, in layers along y. Every other row and every other layer runs backwards, so
// consecutive cells touch, and sixteen consecutive points of a liquid lie together. Only cells that have points are stored: memory
// and time do not depend on how far apart points are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/neighbours/neighbour_group.h"
#include "math/vector.h"
#include "pliant/state.h"

namespace pliant {

class CellOrder {
 public:
  /// Sorts points by cells of the given size [m]. Points of a cell keep their order. Coordinates that are not finite count as far away.
  void sort(std::span<const Record> points, float cell);

  /// For each slot, in the order of cells, the index of its point.
  const std::vector<std::int32_t>& points() const { return order_; }

  /// Replaces `ranges` by ascending ranges of slots that have all points in a box, and some near it.
  void find(const Vec3f& low, const Vec3f& high, std::vector<SlotRange>& ranges) const;

 private:
  /// Columns are half as wide as a cell.
  struct Cell {
    std::int32_t column, layer, row;
  };
  struct Row {
    std::int32_t row, first, last;  ///< its place along z, and its slots
  };
  struct Layer {
    std::int32_t layer, first, last;  ///< its place along y, and its rows
  };

  Cell cell_of(float x, float y, float z) const;
  void make_keys(std::span<const Record> points);
  void sort_keys();
  void sort_by_digit(int shift);
  void list_rows();
  std::int32_t first_column(const Row& row, bool runs_back, std::int32_t column) const;

  float inverse_cell_ = 1;
  Cell least_{}, most_{};
  int column_bits_ = 0, row_bits_ = 0, layer_bits_ = 0;
  std::vector<Cell> cells_;  ///< of each point, then of each slot
  std::vector<std::uint64_t> keys_, keys_before_;
  std::vector<std::int32_t> order_, order_before_;
  std::vector<Row> rows_;
  std::vector<Layer> layers_;
};

}  // namespace pliant
