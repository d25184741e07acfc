// Selects a table of kernels by what this machine runs.
#include "levels/compiled.h"
#include "math/runs_level.h"
#include "pliant/error.h"
#include "surface/surface_kernels.h"

namespace pliant::surface {

std::vector<const SurfaceKernels*> all_kernels() {
  std::vector<const SurfaceKernels*> tables;
#define PLIANT_ADD_LEVEL(suffix, isa, ...) \
  if (runs_##suffix()) tables.push_back(&surface_kernels_##suffix());
  PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_ADD_LEVEL, )
#undef PLIANT_ADD_LEVEL
  return tables;
}

const SurfaceKernels& best_kernels() {
  static const std::vector<const SurfaceKernels*> all = all_kernels();
  if (all.empty()) throw Error({}, "this machine runs no code path of this build", "build it with PLIANT_LEVELS=all");
  return *all.front();
}

}  // namespace pliant::surface
