// Recursive bisection by the number of particles. It divides the rows of a grid into equal pieces, as contiguous groups
// of four need (numbering.h).
#include "topology/tiles.h"

#include <algorithm>
#include <numeric>

namespace pliant {

namespace {

float component(const Vec3f& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int longest_axis(const std::vector<Vec3f>& positions, const int* first, const int* last) {
  Vec3f low = positions[*first], high = low;
  for (const int* i = first; i != last; ++i) {
    const Vec3f& p = positions[*i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

void bisect(const std::vector<Vec3f>& positions, int* first, int* last, int levels, int& next_tile,
            std::vector<int>& tile) {
  if (first == last) return;  // more bisections than particles: empty tiles get no number
  if (levels == 0) {
    for (int* i = first; i != last; ++i) tile[*i] = next_tile;
    ++next_tile;
    return;
  }
  const int axis = longest_axis(positions, first, last);
  int* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](int a, int b) {
    const float ca = component(positions[a], axis), cb = component(positions[b], axis);
    return ca != cb ? ca < cb : a < b;
  });
  bisect(positions, first, middle, levels - 1, next_tile, tile);
  bisect(positions, middle, last, levels - 1, next_tile, tile);
}

}  // namespace

std::vector<int> cut_into_tiles(const std::vector<Vec3f>& positions, int largest) {
  const int n = static_cast<int>(positions.size());
  std::vector<int> tile(n, 0);
  if (n == 0) return tile;
  int levels = 0;
  while ((n + (1 << levels) - 1) >> levels > largest) ++levels;
  std::vector<int> index(n);
  std::iota(index.begin(), index.end(), 0);
  int next_tile = 0;
  bisect(positions, index.data(), index.data() + n, levels, next_tile, tile);
  return tile;
}

}  // namespace pliant
