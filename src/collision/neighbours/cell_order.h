// Points in the order of the cells of a grid, so that points that are close in space are close in memory.
//
// Cells are rows along x, one behind another along z, in layers along y. Every other row and every other layer runs
// backwards, so consecutive cells touch, and sixteen consecutive points of a liquid lie together. Only cells that have
// points are stored: memory and time do not depend on how far apart points are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/neighbours/neighbour_group.h"
#include "math/vector.h"
#include "parallel/executor.h"
#include "pliant/state.h"

namespace pliant {

class CellOrder {
 public:
  /// Sorts points by cells of the given size [m], on all threads. Points of a cell keep their order. Coordinates that
  /// are not finite count as far away.
  void sort(Executor& executor, std::span<const Record> points, float cell);

  /// For each slot, in the order of cells, the index of its point.
  const std::vector<std::int32_t>& points() const { return order_; }

  /// Replaces `ranges` by ascending ranges of slots that have all points in a box, and some near it.
  void find(const Vec3f& low, const Vec3f& high, std::vector<SlotRange>& ranges) const;

 private:
  /// Columns are half as wide as a cell.
  struct Cell {
    std::int32_t column, layer, row;
  };
  /// Places count from the first in the order of slots.
  struct Row {
    std::int32_t place, first, last;      ///< along z, and its slots
    std::int32_t column = 0, extent = 0;  ///< of its first slot, and to that of its last one
    std::int64_t starts = -1;             ///< where in `starts_` its columns are; -1: it has none
  };
  struct Layer {
    std::int32_t place, first, last;  ///< along y, and its rows
  };
  struct Box {
    Cell least, most;
  };
  static constexpr int most_digit_bits = 11;
  using Counts = std::array<std::int32_t, 1 << most_digit_bits>;

  Cell cell_of(float x, float y, float z) const;
  void find_cells(Executor& executor, std::span<const Record> points);
  std::uint64_t key_of(std::uint64_t packed_cell) const;
  void sort_keys(Executor& executor);
  bool sort_by_digit(Executor& executor, int shift, int bits);
  void list_rows();
  void list_columns(Row& row);
  std::int32_t column_of(std::int32_t slot) const;
  std::int32_t first_at(const Row& row, std::int32_t column) const;

  float inverse_cell_ = 1;
  Cell least_{}, most_{};
  int column_bits_ = 0, row_bits_ = 0, layer_bits_ = 0;
  std::vector<std::uint64_t> keys_, keys_before_;  ///< by slot: layer, row and column in their order
  std::vector<std::int32_t> order_, order_before_;
  std::vector<Box> boxes_;      ///< of each chunk
  std::vector<Counts> counts_;  ///< of each chunk
  std::vector<Row> rows_;
  std::vector<Layer> layers_;
  std::vector<std::int32_t> starts_;  ///< of rows that are full: the first slot at or behind each column
};

}  // namespace pliant
