// A data-parallel loop on any backend: launch(backend, "name",
// n, functor) calls functor(i) once for every i in [0, n).
//
// A functor is plain data with a PLIANT_HD operator()(int) const for one item. On the host, threads share blocks of
// items; on a CUDA device the functor is the body of a kernel (launch_cuda.h). No item may read what another writes, so
// the order of items is irrelevant and the bits are the same everywhere.
#pragma once

#include <algorithm>
#include <type_traits>

#include "parallel/executor.h"

namespace pliant {

/// Number of items per task on the host.
inline constexpr int launch_block = 1024;

constexpr int launch_blocks(int n) { return n / launch_block + (n % launch_block != 0 ? 1 : 0); }

/// Runs the functor for all items of one block.
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
