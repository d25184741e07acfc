// Sorts points along a Morton curve (Morton 1966): interleaved coordinate bits keep near points close in order.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// Fills `order` with the point indices 0..n-1, sorted by Morton code and, where codes are equal, by index. Codes have
/// 21 bits per axis over the points' bounding box. Points that are not finite count as its lowest corner. O(n).
class MortonSorter {
 public:
  void sort(const std::vector<Vec3f>& points, std::vector<int>& order);

 private:
  struct Key {
    std::uint64_t code;
    int id;
  };
  void radix_sort();

  std::vector<Key> keys_, spare_;
};

}  // namespace pliant
