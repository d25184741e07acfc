// Sorts things by keys that stand for cells.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/executor.h"
#include "surface/grid_key.h"

namespace pliant::surface {

/// Things [first, last), and the key of their cell within a KeyBox.
struct Keyed {
  std::uint64_t key;
  int first, last;
};

/// A box of cells, and short keys of the cells in it. They ascend as those of key_of.
struct KeyBox {
  Cell low{key_range, key_range, key_range}, high{-key_range, -key_range, -key_range};
  int x_bits = 0, y_bits = 0, z_bits = 0;

  void include(const Cell& c);
  void include(const KeyBox& other);
  /// Must be called after the last include and before keys are asked for.
  void count_bits();
  int bits() const { return x_bits + y_bits + z_bits; }
  std::uint64_t key(const Cell& c) const {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i); };
    return (part(c.z - low.z) << y_bits | part(c.y - low.y)) << x_bits | part(c.x - low.x);
  }
  Cell cell(std::uint64_t key) const {
    const auto part = [key](int shift, int bits) {
      return static_cast<int>(key >> shift & ((std::uint64_t{1} << bits) - 1));
    };
    return {low.x + part(0, x_bits), low.y + part(x_bits, y_bits), low.z + part(x_bits + y_bits, z_bits)};
  }
};

/// Sorts by keys of so many bits, on all threads. Items with equal keys keep their order.
void sort_by_key(Executor& executor, std::vector<Keyed>& items, int bits);

}  // namespace pliant::surface
