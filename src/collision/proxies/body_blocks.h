// Gives each body a contiguous part of an array in which bodies come and go: the part of a removed body becomes a hole, and no
// other body moves.
#pragma once

#include <vector>

#include "model/blocks.h"

namespace pliant {

/// Entries `first` to `first` + `size` - 1 of an array.
struct Block {
  int first = 0, size = 0;

  int end() const { return first + size; }
  bool has(int i) const { return i >= first && i < end(); }
};

class BodyBlocks {
 public:
  /// `body` must have no block.
  Block take(int body, int size) {
    if (blocks_.size() <= static_cast<std::size_t>(body)) blocks_.resize(static_cast<std::size_t>(body) + 1);
    return blocks_[static_cast<std::size_t>(body)] = {allocator_.allocate(size, body), size};
  }
  /// Returns the block that the body had.
  Block release(int body) {
    if (static_cast<std::size_t>(body) >= blocks_.size()) return {};
    const Block had = blocks_[static_cast<std::size_t>(body)];
    allocator_.release(had.first, had.size);
    blocks_[static_cast<std::size_t>(body)] = {};
    return had;
  }
  /// Size 0 for a body without a block.
  Block operator[](int body) const {
    return static_cast<std::size_t>(body) < blocks_.size() ? blocks_[static_cast<std::size_t>(body)] : Block{};
  }
  /// One past the last entry in use.
  std::size_t end() const { return static_cast<std::size_t>(allocator_.end()); }

 private:
  BlockAllocator allocator_;
  std::vector<Block> blocks_;
};

}  // namespace pliant
