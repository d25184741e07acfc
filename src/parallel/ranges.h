// Parallel loops over many items, a range of consecutive ones in each task.
#pragma once

#include <algorithm>

#include "parallel/executor.h"

namespace pliant {

/// The number of ranges of `length` items that `count` items fill. The last one may have fewer.
constexpr int ranges_of(int count, int length) { return count > 0 ? (count - 1) / length + 1 : 0; }

/// Calls body(first, last) for each of these ranges [first, last) on all threads. It is number first / length. The loop
/// is timed under `name` unless it is null.
template <class Body>
void for_ranges(Executor& executor, const char* name, int count, int length, const Body& body) {
  executor.parallel_for(name, ranges_of(count, length), [&](int range) {
    const int first = range * length;
    body(first, first + std::min(length, count - first));
  });
}

/// Calls body(i) for each i in [0, count) on all threads, `length` of them in a task.
template <class Body>
void for_items(Executor& executor, const char* name, int count, int length, const Body& body) {
  for_ranges(executor, name, count, length, [&](int first, int last) {
    for (int i = first; i < last; ++i) body(i);
  });
}

}  // namespace pliant
