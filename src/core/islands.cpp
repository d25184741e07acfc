#include "core/islands.h"

#include <algorithm>
#include <numeric>

namespace pliant {

void Islands::reset(int size) {
  parent_.resize(static_cast<std::size_t>(size));
  std::iota(parent_.begin(), parent_.end(), 0);
}

int Islands::find(int number) {
  while (parent(number) != number) {
    parent(number) = parent(parent(number));
    number = parent(number);
  }
  return number;
}

void Islands::unite(int a, int b) {
  const int one = find(a), other = find(b);
  parent(std::max(one, other)) = std::min(one, other);
}

}  // namespace pliant
