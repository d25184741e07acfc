// Selects a kernel table: the best for this CPU, or one by name.
#include <algorithm>
#include <iterator>
#include <string>

#include "collision/neighbours/neighbour_kernels.h"
#include "collision/proxies/pair_kernels.h"
#include "levels/compiled.h"
#include "math/runs_level.h"
#include "pliant/error.h"
#include "solver/air_kernels.h"
#include "solver/bodies/manifold_kernels.h"
#include "solver/bodies/rod_kernels.h"
#include "solver/contact_kernels.h"
#include "solver/fluids/fluid_kernels.h"
#include "solver/fluids/tension_kernels.h"
#include "solver/fluids/viscosity_kernels.h"
#include "solver/kernels.h"
#include "solver/length_kernels.h"
#include "solver/motion_kernels.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/multigrid_kernels.h"

namespace pliant {

namespace {

#define PLIANT_LEVEL_TABLE(suffix, isa, ...)                                                                          \
  const Kernels& kernels_##suffix() {                                                                                 \
    static const Kernels table{sweep_kernels_##suffix(),  step_kernels_##suffix(),      isa,                          \
                               chain_kernels_##suffix(),  multigrid_kernels_##suffix(), contact_kernels_##suffix(),   \
                               length_kernels_##suffix(), pair_kernels_##suffix(),      manifold_kernels_##suffix(),  \
                               rod_kernels_##suffix(),    motion_kernels_##suffix(),    neighbour_kernels_##suffix(), \
                               fluid_kernels_##suffix(),  viscosity_kernels_##suffix(), tension_kernels_##suffix(),   \
                               air_kernels_##suffix()};                                                               \
    return table;                                                                                                     \
  }
PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_LEVEL_TABLE, )

struct Level {
  const Kernels& (*kernels)();
  bool (*runs)();
};
#define PLIANT_LEVEL_ENTRY(suffix, isa, ...) {kernels_##suffix, runs_##suffix},
constexpr Level levels[] = {PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_LEVEL_ENTRY, )};

std::string level_names() {
  std::string names;
  for (const Level& level : levels) names += std::string(level.kernels().isa) + ", ";
  return names;
}

}  // namespace

const Kernels& kernels_sequential() {
  static const Kernels table{sweep_kernels_sequential(),
                             step_kernels_sequential(),
                             "sequential",
                             chain_kernels_sequential(),
                             PLIANT_OF_BASE_LEVEL(multigrid_kernels)(),
                             contact_kernels_sequential(),
                             length_kernels_sequential(),
                             base_pair_kernels(),
                             manifold_kernels_sequential(),
                             rod_kernels_sequential(),
                             motion_kernels_sequential(),
                             neighbour_kernels_sequential(),
                             fluid_kernels_sequential(),
                             viscosity_kernels_sequential(),
                             tension_kernels_sequential(),
                             air_kernels_sequential()};
  return table;
}

const Kernels& pick_kernels(const std::string& isa) {
  const auto runs = [](const Level& level) { return level.runs(); };
  if (std::none_of(std::begin(levels), std::end(levels), runs))
    throw Error({}, "this machine runs none of the code paths of this build: " + level_names() + "sequential",
                "build it with PLIANT_LEVELS=all");
  if (isa == kernels_sequential().isa) return kernels_sequential();
  for (const Level& level : levels) {
    const Kernels& kernels = level.kernels();
    if (isa == kernels.isa && !level.runs())
      throw Error({}, "this machine cannot run the code path '" + isa + "'", "leave settings.isa empty");
    if ((isa.empty() || isa == kernels.isa) && level.runs()) return kernels;
  }
  throw Error({}, "this build has no code path '" + isa + "'", "use " + level_names() + "sequential or leave it empty");
}

}  // namespace pliant
