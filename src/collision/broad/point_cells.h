// Points sorted into the cells of a regular grid, for queries by boxes. The cost of a query follows the points near it.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/broad/bounds.h"
#include "pliant/state.h"

namespace pliant {

class PointCells {
 public:
  /// Sorts the points [first, last) of an array. Numbers of points are those in the array.
  void build(const Record* positions, int first, int last);

  /// A box around all points.
  const BoxBounds& bounds() const { return bounds_; }

  /// Appends the points of all cells that a box overlaps, ascending: all points inside the box, and some beside it.
  void query(const BoxBounds& box, std::vector<std::int32_t>& found) const;

 private:
  /// Along an axis.
  static constexpr int most_cells = 16;

  int cell_along(float x, int axis) const;

  BoxBounds bounds_{};
  float low_[3] = {}, inverse_side_ = 0;
  int cells_[3] = {1, 1, 1};
  std::vector<std::int32_t> first_of_cell_, points_, cell_of_;
};

}  // namespace pliant
