// Where the blocks of a State stand: one contiguous block of particles an object, in one array that all objects share.
//
// A block that goes leaves a hole, and a later block that fits takes the first such hole: nobody is moved, so that removing an
// object costs what that object costs, and memory stays flat where objects come and go. Holes next to one another are one.
#pragma once

#include <iterator>
#include <map>

namespace pliant {

class BlockAllocator {
 public:
  /// The first particle of a new block of `size` particles (0 or more), owned by `owner`.
  int allocate(int size, int owner);
  /// Gives a block back. `first` and `size` are those of allocate.
  void release(int first, int size);

  /// One past the last particle of the last block.
  int end() const { return end_; }
  /// Owner of the block that holds a particle; of one in a hole, some owner or -1.
  int owner_of(int particle) const {
    const auto after = owners_.upper_bound(particle);
    return after == owners_.begin() ? -1 : std::prev(after)->second;
  }

 private:
  int end_ = 0;
  std::map<int, int> owners_;  ///< by the first particle of each block that has some
  std::map<int, int> holes_;   ///< size by first particle; no two touch, and none ends at end_
};

}  // namespace pliant
