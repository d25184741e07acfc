// Sorts what belongs to particles in time linear in its number: a counting sort by one particle of each, then short
// sorts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pliant {

/// Sorts as std::sort(less) does, if `less` compares first(item), an index in [0, count), before all else.
template <class T, class First, class Less>
void sort_by_first(std::vector<T>& items, std::size_t count, const First& first, const Less& less) {
  std::vector<std::size_t> begin(count + 2, 0);
  for (const T& item : items) ++begin[static_cast<std::size_t>(first(item)) + 2];
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<T> sorted(items.size());
  for (T& item : items) sorted[begin[static_cast<std::size_t>(first(item)) + 1]++] = std::move(item);
  const auto at = [&](std::size_t i) { return sorted.begin() + static_cast<std::ptrdiff_t>(begin[i]); };
  for (std::size_t i = 0; i < count; ++i) std::sort(at(i), at(i + 1), less);
  items = std::move(sorted);
}

}  // namespace pliant
