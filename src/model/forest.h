// Union-find.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace pliant {

/// A union-find forest: each member points to an earlier member of its set, the first one to itself.
class Forest {
 public:
  explicit Forest(std::size_t members) : root_(members) { std::iota(root_.begin(), root_.end(), 0); }

  int first_of(int member) {
    while (root_[static_cast<std::size_t>(member)] != member) {
      int& root = root_[static_cast<std::size_t>(member)];
      member = root = root_[static_cast<std::size_t>(root)];
    }
    return member;
  }
  void join(int a, int b) {
    a = first_of(a);
    b = first_of(b);
    root_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> root_;
};

}  // namespace pliant
