// Gives each body a contiguous block of an array. No block ever moves: a removed body leaves unused entries, which
// later blocks may use.
#pragma once

#include <map>

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
  Block take(int body, int size) { return blocks_[body] = {allocator_.allocate(size, body), size}; }
  /// Frees a body's block and returns it.
  Block release(int body) {
    const auto found = blocks_.find(body);
    if (found == blocks_.end()) return {};
    const Block had = found->second;
    allocator_.release(had.first, had.size);
    blocks_.erase(found);
    return had;
  }
  /// The block of a body; its size is 0 if the body has none.
  Block operator[](int body) const {
    const auto found = blocks_.find(body);
    return found != blocks_.end() ? found->second : Block{};
  }
  /// One past the last entry of the array that is in use.
  std::size_t end() const { return static_cast<std::size_t>(allocator_.end()); }

 private:
  BlockAllocator allocator_;
  std::map<int, Block> blocks_;  ///< by body; a group of few bodies has few, whatever their numbers
};

}  // namespace pliant
