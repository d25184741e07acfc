// The block allocator of a State: each object has one contiguous block of particles in one array.
//
// No block ever moves. A removed block leaves a hole, which the first later block that fits takes. So removing an
// object costs no more than its size, and memory stays bounded under repeated additions and removals. Adjacent holes
// are merged.
#pragma once

#include <iterator>
#include <map>

namespace pliant {

class BlockAllocator {
 public:
  /// Returns the first particle of a new block of `size` particles (>= 0), owned by `owner`.
  int allocate(int size, int owner);
  /// Frees the block that begins at `first`; `size` is that given to allocate.
  void release(int first, int size);

  /// One past the last particle of the last block.
  int end() const { return end_; }
  /// The owner of the block that contains a particle. For a particle in a hole the result is any owner, or -1.
  int owner_of(int particle) const {
    const auto after = owners_.upper_bound(particle);
    return after == owners_.begin() ? -1 : std::prev(after)->second;
  }

 private:
  int end_ = 0;
  std::map<int, int> owners_;  ///< key: first particle of each non-empty block
  std::map<int, int> holes_;   ///< size of each hole, by its first particle; no two are adjacent, none ends at end_
};

}  // namespace pliant
