// Morton codes by bit interleaving, ordered by a radix sort, which is stable: equal codes stay in index order.
#include "collision/broad/morton.h"

#include <algorithm>
#include <array>
#include <utility>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr int bits = 21;
/// Fewer points are sorted by comparisons, which is then faster than the radix sort; both give the same order.
constexpr std::size_t fewest_for_radix = 1024;
constexpr double largest_cell = (1 << bits) - 1;

/// Returns the low 21 bits of x with two zero bits after each, to be interleaved with two other coordinates.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffU;
  x = (x | x << 16) & 0x001f0000ff0000ffU;
  x = (x | x << 8) & 0x100f00f00f00f00fU;
  x = (x | x << 4) & 0x10c30c30c30c30c3U;
  return (x | x << 2) & 0x1249249249249249U;
}

std::uint64_t cell(float x, double low, double scale) {
  const double place = (static_cast<double>(x) - low) * scale;
  // This comparison is false for NaN, so a NaN coordinate counts as 0.
  return place > 0 ? static_cast<std::uint64_t>(place < largest_cell ? place : largest_cell) : 0;
}

bool finite(float x) { return abs(x) <= 3.4e38f; }

}  // namespace

void MortonSorter::sort(const std::vector<Vec3f>& points, std::vector<int>& order) {
  Vec3d low{1e39, 1e39, 1e39}, high{-1e39, -1e39, -1e39};
  for (const Vec3f& p : points) {
    if (!finite(p.x) || !finite(p.y) || !finite(p.z)) continue;
    low = min(low, convert<double>(p));
    high = max(high, convert<double>(p));
  }
  const double extent = max(max(high.x - low.x, high.y - low.y), max(high.z - low.z, 1e-300));
  const double scale = largest_cell / extent;
  keys_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f& p = points[i];
    const std::uint64_t code =
        spread(cell(p.x, low.x, scale)) | spread(cell(p.y, low.y, scale)) << 1 | spread(cell(p.z, low.z, scale)) << 2;
    keys_[i] = {code, static_cast<int>(i)};
  }
  if (points.size() < fewest_for_radix) {
    std::sort(keys_.begin(), keys_.end(),
              [](const Key& x, const Key& y) { return x.code != y.code ? x.code < y.code : x.id < y.id; });
  } else {
    radix_sort();
  }
  order.resize(points.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) order[i] = keys_[i].id;
}

void MortonSorter::radix_sort() {
  spare_.resize(keys_.size());
  constexpr int digit = 11;
  for (int shift = 0; shift < 3 * bits; shift += digit) {
    std::array<std::size_t, (1 << digit) + 1> start{};
    const auto digit_of = [shift](const Key& key) { return (key.code >> shift) & ((1U << digit) - 1); };
    for (const Key& key : keys_) ++start[digit_of(key) + 1];
    for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
    for (const Key& key : keys_) spare_[start[digit_of(key)]++] = key;
    std::swap(keys_, spare_);
  }
}

}  // namespace pliant
