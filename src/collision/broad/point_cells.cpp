#include "collision/broad/point_cells.h"

#include <algorithm>
#include <cstddef>

namespace pliant {

int PointCells::cell_along(float x, int axis) const {
  const float cell = (x - low_[axis]) * inverse_side_;
  return static_cast<int>(min(max(cell, 0.f), static_cast<float>(cells_[axis] - 1)));
}

void PointCells::build(const Record* positions, int first, int last) {
  const auto place = [&](int i) { return Vec3f{positions[i].x, positions[i].y, positions[i].z}; };
  bounds_ = first < last ? BoxBounds{place(first), place(first)} : BoxBounds{};
  for (int i = first; i < last; ++i) bounds_ = {min(bounds_.low, place(i)), max(bounds_.high, place(i))};
  const Vec3f size = bounds_.high - bounds_.low;
  const float side = max(max(size.x, max(size.y, size.z)) * (1.f / most_cells), 1e-30f);
  inverse_side_ = 1 / side;
  const float low[3] = {bounds_.low.x, bounds_.low.y, bounds_.low.z}, sizes[3] = {size.x, size.y, size.z};
  for (int axis = 0; axis < 3; ++axis) {
    low_[axis] = low[axis];
    cells_[axis] = std::clamp(static_cast<int>(min(sizes[axis] * inverse_side_, 1e6f)) + 1, 1, most_cells);
  }
  first_of_cell_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  cell_of_.clear();
  for (int i = first; i < last; ++i) {
    const Vec3f p = place(i);
    cell_of_.push_back((cell_along(p.z, 2) * cells_[1] + cell_along(p.y, 1)) * cells_[0] + cell_along(p.x, 0));
    ++first_of_cell_[static_cast<std::size_t>(cell_of_.back()) + 1];
  }
  for (std::size_t c = 1; c < first_of_cell_.size(); ++c) first_of_cell_[c] += first_of_cell_[c - 1];
  points_.resize(cell_of_.size());
  for (int i = last; i-- > first;) {  // from the end, which turns the ends of cells into their beginnings
    std::int32_t& next = first_of_cell_[static_cast<std::size_t>(cell_of_[static_cast<std::size_t>(i - first)]) + 1];
    points_[static_cast<std::size_t>(--next)] = i;
  }
}

void PointCells::query(const BoxBounds& box, std::vector<std::int32_t>& found) const {
  if (points_.empty() || !overlap(box, bounds_)) return;
  const std::size_t before = found.size();
  const int x0 = cell_along(box.low.x, 0), x1 = cell_along(box.high.x, 0);
  int rows = 0;
  for (int z = cell_along(box.low.z, 2); z <= cell_along(box.high.z, 2); ++z)
    for (int y = cell_along(box.low.y, 1); y <= cell_along(box.high.y, 1); ++y) {
      const int row = (z * cells_[1] + y) * cells_[0];
      const auto begin_of = [&](int cell) {
        return points_.begin() + first_of_cell_[static_cast<std::size_t>(cell) + 1];
      };
      const auto end_of = [&](int cell) {
        const std::size_t next = static_cast<std::size_t>(cell) + 2;
        return next < first_of_cell_.size() ? points_.begin() + first_of_cell_[next] : points_.end();
      };
      found.insert(found.end(), begin_of(row + x0), end_of(row + x1));
      ++rows;
    }
  if (rows > 1 || x1 > x0) std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end());
}

}  // namespace pliant
