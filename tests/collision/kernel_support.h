// The pair kernels that this machine can run.
#pragma once

#include <vector>

#include "collision/proxies/pair_kernels.h"
#include "levels/compiled.h"
#include "math/runs_level.h"

namespace pliant::testing_support {

/// All of them; the first runs on any machine.
inline std::vector<const PairKernels*> all_kernels() {
  std::vector<const PairKernels*> all;
#define PLIANT_ADD_LEVEL(suffix, isa, ...) \
  if (runs_##suffix()) all.insert(all.begin(), &pair_kernels_##suffix());
  PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_ADD_LEVEL, )
#undef PLIANT_ADD_LEVEL
  return all;
}

}  // namespace pliant::testing_support
