// Gives each body a contiguous block of an array. No block ever moves: a removed body leaves unused entries, which
// later blocks may use.
#pragma once

#include <vector>

#include "model/blocks.h"

namespace pliant {

/// A block: entries `first` to `first` + `size` - 1 of an array.
struct Block {
  int first = 0, size = 0;

  int end() const { return first + size; }
  bool has(int i) const { return i >= first && i < end(); }
};

class BodyBlocks {
 public:
  /// Allocates a block of `size` entries for a body that has none.
  Block take(int body, int size) {
    if (blocks_.size() <= static_cast<std::size_t>(body)) blocks_.resize(static_cast<std::size_t>(body) + 1);
    return blocks_[static_cast<std::size_t>(body)] = {allocator_.allocate(size, body), size};
  }
  /// Frees a body's block and returns it.
  Block release(int body) {
    if (static_cast<std::size_t>(body) >= blocks_.size()) return {};
    const Block had = blocks_[static_cast<std::size_t>(body)];
    allocator_.release(had.first, had.size);
    blocks_[static_cast<std::size_t>(body)] = {};
    return had;
  }
  /// The block of a body; its size is 0 if the body has none.
  Block operator[](int body) const {
    return static_cast<std::size_t>(body) < blocks_.size() ? blocks_[static_cast<std::size_t>(body)] : Block{};
  }
  /// One past the last entry of the array that is in use.
  std::size_t end() const { return static_cast<std::size_t>(allocator_.end()); }

 private:
  BlockAllocator allocator_;
  std::vector<Block> blocks_;
};

}  // namespace pliant
