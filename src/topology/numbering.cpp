#include "topology/numbering.h"

#include <algorithm>
#include <cstddef>

namespace pliant {

namespace {

/// Lists particles sorted by tile, then by old index (a counting sort).
std::vector<int> sorted_by_tile(const std::vector<int>& tile) {
  const int tiles = tile.empty() ? 0 : *std::max_element(tile.begin(), tile.end()) + 1;
  std::vector<int> begin(static_cast<std::size_t>(tiles) + 1, 0);
  for (int t : tile) ++begin[t + 1];
  for (int t = 0; t < tiles; ++t) begin[t + 1] += begin[t];
  std::vector<int> sorted(tile.size());
  for (int i = 0; i < static_cast<int>(tile.size()); ++i) sorted[begin[tile[i]]++] = i;
  return sorted;
}

}  // namespace

std::vector<int> number_in_chains(const std::vector<int>& tile, const std::vector<char>& linked_to_next) {
  const std::vector<int> sorted = sorted_by_tile(tile);
  std::vector<int> order;
  order.reserve(sorted.size());
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t last = first + 1;
    while (last < sorted.size() && sorted[last] == sorted[last - 1] + 1 && linked_to_next[sorted[last - 1]] &&
           tile[sorted[last]] == tile[sorted[first]]) {
      ++last;
    }
    for (std::size_t i = first; i < last; i += 2) order.push_back(sorted[i]);
    for (std::size_t i = first + 1; i < last; i += 2) order.push_back(sorted[i]);
    first = last;
  }
  return order;
}

}  // namespace pliant
