// Fills the hash table by a counting sort: entries per slot, prefix sums, entries in the order of their indices.
#include "reference/spatial_hash.h"

#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

constexpr double most_cells_of_a_box = 64;

/// floor(x), clamped to the range of an int. It is monotonic, so adjacent cells stay adjacent.
int floor_to_int(double x) {
  constexpr double limit = 1 << 30;
  if (!(x > -limit)) return -(1 << 30);
  if (x >= limit) return 1 << 30;
  const int whole = static_cast<int>(x);
  return static_cast<double>(whole) > x ? whole - 1 : whole;
}

}  // namespace

SpatialHash::SpatialHash(float cell_size) : inverse_size_(1 / static_cast<double>(cell_size)) {
  if (!(cell_size > 0) || !(inverse_size_ > 0))
    throw Error({}, "a cell of " + std::to_string(cell_size) + " m are impossible", "give a cell size above 0");
  start_.assign(2, 0);
}

SpatialHash::Cell SpatialHash::cell_of(const Vec3f& p) const {
  const Vec3d place = convert<double>(p) * inverse_size_;
  return {floor_to_int(place.x), floor_to_int(place.y), floor_to_int(place.z)};
}

double SpatialHash::cell_count(const Cell& first, const Cell& last) {
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) count *= static_cast<double>(last[k]) - static_cast<double>(first[k]) + 1;
  return count;
}

void SpatialHash::build(const std::vector<BoxBounds>& boxes) {
  boxes_ = boxes;
  std::uint32_t places = 16;
  while (places < boxes.size() * 2 && places < (1U << 30)) places *= 2;
  mask_ = places - 1;
  count_entries();
  entries_.resize(start_.back());
  // Backwards, so that the ends of slots become their starts, and indices ascend within a slot.
  for (int i = static_cast<int>(boxes_.size()) - 1; i >= 0; --i) {
    const BoxBounds& box = boxes_[static_cast<std::size_t>(i)];
    if (is_large_[static_cast<std::size_t>(i)]) continue;
    each_cell(cell_of(box.low), cell_of(box.high), [&](const Cell& cell) {
      entries_[--start_[place_of(cell)]] = {cell, i};
    });
  }
}

/// Writes the end of each slot's entries to start_[slot].
void SpatialHash::count_entries() {
  start_.assign(static_cast<std::size_t>(mask_) + 2, 0);
  is_large_.assign(boxes_.size(), 0);
  large_.clear();
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Cell first = cell_of(boxes_[i].low), last = cell_of(boxes_[i].high);
    if (cell_count(first, last) > most_cells_of_a_box) {
      large_.push_back(static_cast<int>(i));
      is_large_[i] = 1;
      continue;
    }
    each_cell(first, last, [&](const Cell& cell) { ++start_[place_of(cell)]; });
  }
  for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
}

}  // namespace pliant
