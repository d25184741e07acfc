// The pair kernels that this machine can run.
#pragma once

#include <vector>

#include "collision/proxies/pair_kernels.h"

namespace pliant::testing_support {

/// All of them; the first runs on any machine.
inline std::vector<const PairKernels*> all_kernels() {
  std::vector<const PairKernels*> all{&pair_kernels_generic()};
#if defined(__x86_64__)
  all.push_back(&pair_kernels_v2());
  if (__builtin_cpu_supports("avx2")) all.push_back(&pair_kernels_v3());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    all.push_back(&pair_kernels_v4());
#endif
  return all;
}

}  // namespace pliant::testing_support
