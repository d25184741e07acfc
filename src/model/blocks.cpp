#include "model/blocks.h"

#include <algorithm>
#include <iterator>

namespace pliant {

int BlockAllocator::allocate(int size, int owner) {
  if (size == 0) return end_;
  const auto hole = std::find_if(holes_.begin(), holes_.end(), [&](const auto& one) { return one.second >= size; });
  int first = end_;
  if (hole == holes_.end()) {
    end_ += size;
  } else {
    first = hole->first;
    const int left = hole->second - size;
    holes_.erase(hole);
    if (left > 0) holes_.emplace(first + size, left);
  }
  owners_.emplace(first, owner);
  return first;
}

void BlockAllocator::release(int first, int size) {
  if (size == 0) return;
  owners_.erase(first);
  auto after = holes_.lower_bound(first);
  if (after != holes_.end() && after->first == first + size) {
    size += after->second;
    after = holes_.erase(after);
  }
  if (after != holes_.begin()) {
    const auto before = std::prev(after);
    if (before->first + before->second == first) {
      first = before->first;
      size += before->second;
      holes_.erase(before);
    }
  }
  if (first + size == end_) {
    end_ = first;
  } else {
    holes_.emplace(first, size);
  }
}

}  // namespace pliant
