// The same work for each of n items, on any machine: launch(backend, "name", n, functor) calls functor(i) once for every i in
// [0, n).
//
// A functor is plain data, pointers and numbers, whose PLIANT_HD operator()(int) const is the text of one item. Here threads share
// out blocks of items; on a CUDA device the same functor is the body of a kernel (launch_cuda.h). No item may read what another
// writes, so that the order of items is nobody's affair and the bits are the same everywhere.
#pragma once

#include <algorithm>
#include <type_traits>

#include "parallel/executor.h"

namespace pliant {

/// Items that one task of the host visits.
inline constexpr int launch_block = 1024;

constexpr int launch_blocks(int n) { return n / launch_block + (n % launch_block != 0 ? 1 : 0); }

/// The items of one block.
template <class Functor>
void run_block(const Functor& functor, int block, int n) {
  const int first = block * launch_block, last = first + std::min(launch_block, n - first);
  for (int i = first; i < last; ++i) functor(i);
}

template <class Functor>
void launch(Executor& host, const char* name, int n, const Functor& functor) {
  static_assert(std::is_trivially_copyable_v<Functor>, "a functor is copied to a device as bytes");
  host.parallel_for(name, launch_blocks(n), [&](int block) { run_block(functor, block, n); });
}

}  // namespace pliant
