// An order of points along a curve that keeps what is near together: bits of the coordinates interleaved (Morton 1966).
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// Puts into `order` the numbers 0..n-1 of the points, ascending by code, points of one code by number: a total order. Codes
/// have 21 bits an axis over the points' own box. What is not finite counts as the lowest corner. O(n).
class MortonSorter {
 public:
  void sort(const std::vector<Vec3f>& points, std::vector<int>& order);

 private:
  struct Key {
    std::uint64_t code;
    int id;
  };
  std::vector<Key> keys_, spare_;
};

}  // namespace pliant
