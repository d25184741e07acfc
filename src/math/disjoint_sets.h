// Sets of numbers that are joined one after another (union-find with path halving: Tarjan and van Leeuwen 1984).
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace pliant {

class DisjointSets {
 public:
  /// Sets of one number each, from 0.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t count() const { return parent_.size(); }

  /// The lowest number of the set that has i.
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t x = root(a), y = root(b);
    parent_[x < y ? y : x] = x < y ? x : y;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace pliant
