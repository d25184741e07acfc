// Cells of an unbounded grid: integer coordinates, the keys that stand for them, and a table from keys to indices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.h"

namespace pliant::surface {

/// Integer coordinates of a cell, a block or a node.
struct Cell {
  int x = 0, y = 0, z = 0;
};

/// Coordinates must lie in [-key_range, key_range).
inline constexpr int key_range = 1 << 20;

/// The largest integer that is not above v.
inline int floor_of(float v) {
  const int truncated = static_cast<int>(v);
  return truncated - (static_cast<float>(truncated) > v ? 1 : 0);
}

/// The cell that contains p, where 1 / side is given.
inline Cell cell_at(const Vec3f& p, float per_side) {
  return {floor_of(p.x * per_side), floor_of(p.y * per_side), floor_of(p.z * per_side)};
}

/// Keys ascend with z, then y, then x.
inline std::uint64_t key_of(const Cell& c) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(i) + key_range; };
  return part(c.z) << 42 | part(c.y) << 21 | part(c.x);
}

inline Cell cell_of(std::uint64_t key) {
  const auto part = [key](int shift) { return static_cast<int>(key >> shift & (2 * key_range - 1)) - key_range; };
  return {part(0), part(21), part(42)};
}

/// What to add to the key of a cell for that of another one, so far along each axis.
inline std::uint64_t key_step(int x, int y, int z) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(i)); };
  return (part(z) << 42) + (part(y) << 21) + part(x);
}

/// Finds keys in an ascending list, by going on from where the last one was.
class KeyFollower {
 public:
  KeyFollower() = default;
  /// Starts at the first key that is not below `from`.
  KeyFollower(std::span<const std::uint64_t> keys, std::uint64_t from)
      : keys_(keys), next_(static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), from) - keys.begin())) {}
  /// The index of the first key that is not below `key`, which is not below that of the last call.
  int first_from(std::uint64_t key) {
    while (next_ < keys_.size() && keys_[next_] < key) ++next_;
    return static_cast<int>(next_);
  }

 private:
  std::span<const std::uint64_t> keys_;
  std::size_t next_ = 0;
};

/// Finds the index that belongs to a key. Open addressing with linear probing; nothing iterates over it.
class KeyTable {
 public:
  explicit KeyTable(std::size_t expected = 0);

  /// The index of a key, or -1.
  int find(std::uint64_t key) const;
  /// Adds a key with the number of keys so far as its index. False if the table has it already.
  bool insert(std::uint64_t key);
  std::size_t size() const { return size_; }

 private:
  struct Slot {
    std::uint64_t key = ~std::uint64_t{0};
    int index = -1;
  };
  std::size_t slot_of(std::uint64_t key) const;
  void grow();
  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace pliant::surface
