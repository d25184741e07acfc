// An unbounded uniform grid: cells are hashed into a table and filled by count, scan and fill.
//
// Teschner et al. 2003, "Optimized spatial hashing for collision detection of deformable objects",
// with these details. Cells use floor, not truncation. Entries store their cell, so colliding
// cells in a slot are never mixed. A pair of boxes is reported only in the cell where both begin,
// so never twice. Boxes much larger than a cell are kept in a separate list. Entries of a slot are
// in index order: the same input gives the same result in the same order on any machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/broad/bounds.h"

namespace pliant {

class SpatialHash {
 public:
  /// `cell_size` > 0 [m]; best is about the size of the boxes. Throws an Error if it is not positive.
  explicit SpatialHash(float cell_size);

  /// Replaces the content by finite boxes; for points, low = high. Allocates memory only to grow.
  void build(const std::vector<BoxBounds>& boxes);

  /// Calls visit(i) once for each box that overlaps `box`.
  template <class Visit>
  void query(const BoxBounds& box, const Visit& visit) const;

  /// Calls visit(a, b), a < b, once for each pair of overlapping boxes.
  template <class Visit>
  void self_pairs(const Visit& visit) const;

 private:
  using Cell = std::array<int, 3>;
  struct Entry {
    Cell cell;
    int id;
  };

  Cell cell_of(const Vec3f& p) const;
  std::size_t place_of(const Cell& cell) const {
    const auto part = [](int x, std::uint32_t prime) { return static_cast<std::uint32_t>(x) * prime; };
    return (part(cell[0], 73856093U) ^ part(cell[1], 19349663U) ^ part(cell[2], 83492791U)) & mask_;
  }
  template <class Visit>
  static void each_cell(const Cell& first, const Cell& last, const Visit& visit);
  static double cell_count(const Cell& first, const Cell& last);
  /// The only cell in which a pair of overlapping boxes is reported.
  Cell home(const BoxBounds& a, const BoxBounds& b) const { return cell_of(max(a.low, b.low)); }
  void count_entries();

  double inverse_size_;
  std::uint32_t mask_ = 0;
  std::vector<BoxBounds> boxes_;
  std::vector<std::uint32_t> start_;  ///< first entry of each slot
  std::vector<Entry> entries_;
  std::vector<int> large_;  ///< boxes that span too many cells, ascending
  std::vector<char> is_large_;
};

template <class Visit>
void SpatialHash::each_cell(const Cell& first, const Cell& last, const Visit& visit) {
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) visit(Cell{x, y, z});
}

template <class Visit>
void SpatialHash::query(const BoxBounds& box, const Visit& visit) const {
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  const Cell first = cell_of(box.low), last = cell_of(box.high);
  if (cell_count(first, last) > static_cast<double>(entries_.size() + 8)) {  // more cells than entries: visit these
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i)
      if (overlap(boxes_[index(i)], box)) visit(i);
    return;
  }
  for (const int i : large_)
    if (overlap(boxes_[index(i)], box)) visit(i);
  each_cell(first, last, [&](const Cell& cell) {
    const std::size_t place = place_of(cell);
    for (std::uint32_t k = start_[place]; k < start_[place + 1]; ++k) {
      const Entry& entry = entries_[k];
      const BoxBounds& other = boxes_[index(entry.id)];
      if (entry.cell == cell && overlap(other, box) && home(other, box) == cell) visit(entry.id);
    }
  });
}

template <class Visit>
void SpatialHash::self_pairs(const Visit& visit) const {
  const auto box = [&](int i) -> const BoxBounds& { return boxes_[static_cast<std::size_t>(i)]; };
  for (std::size_t place = 0; place + 1 < start_.size(); ++place)
    for (std::uint32_t i = start_[place]; i < start_[place + 1]; ++i)
      for (std::uint32_t k = i + 1; k < start_[place + 1]; ++k) {
        const Entry &a = entries_[i], &b = entries_[k];
        if (a.cell == b.cell && overlap(box(a.id), box(b.id)) && home(box(a.id), box(b.id)) == a.cell)
          visit(a.id, b.id);
      }
  for (const int a : large_)
    for (int b = 0; b < static_cast<int>(boxes_.size()); ++b) {
      if (b == a || (is_large_[static_cast<std::size_t>(b)] && b < a) || !overlap(box(a), box(b))) continue;
      if (a < b) {
        visit(a, b);
      } else {
        visit(b, a);
      }
    }
}

}  // namespace pliant
