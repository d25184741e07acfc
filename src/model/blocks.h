// The block allocator of a State: one contiguous block of particles per object, in one shared array.
//
// A removed block leaves a hole, which the first later block that fits reuses. No block ever moves, so removing an object
// costs no more than its size, and memory stays constant under repeated additions and removals. Adjacent holes are merged.
#pragma once

#include <iterator>
#include <map>

namespace pliant {

class BlockAllocator {
 public:
  /// Returns the first particle of a new block of `size` particles (>= 0), owned by `owner`.
  int allocate(int size, int owner);
  /// Releases a block. `first` and `size` are those of allocate.
  void release(int first, int size);

  /// One past the last particle of the last block.
  int end() const { return end_; }
  /// The owner of the block that contains a particle; in a hole, any owner or -1.
  int owner_of(int particle) const {
    const auto after = owners_.upper_bound(particle);
    return after == owners_.begin() ? -1 : std::prev(after)->second;
  }

 private:
  int end_ = 0;
  std::map<int, int> owners_;  ///< owner of each non-empty block, by its first particle
  std::map<int, int> holes_;   ///< size by first particle; no two touch, and none ends at end_
};

}  // namespace pliant
