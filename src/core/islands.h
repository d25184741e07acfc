// Islands: sets of things that act on one another, found by union of pairs.
#pragma once

#include <cstddef>
#include <vector>

namespace pliant {

/// Disjoint sets of the numbers 0 to size - 1. The smallest number of a set names it, so the names do not depend on the
/// order in which pairs are united. Paths are halved (Tarjan, van Leeuwen 1984), so the cost is almost linear in the
/// number of pairs.
class Islands {
 public:
  /// Makes each of `size` numbers a set of its own.
  void reset(int size);
  void unite(int a, int b);
  /// The smallest number in the set of `number`.
  int find(int number);
  int size() const { return static_cast<int>(parent_.size()); }

 private:
  int& parent(int number) { return parent_[static_cast<std::size_t>(number)]; }

  std::vector<int> parent_;  ///< never larger than the number itself; the same for a set's smallest
};

}  // namespace pliant
