// The public list of sweeps and their names.
#include "pliant/scene.h"

namespace pliant {

const std::vector<NamedSweep>& sweeps() {
  static const std::vector<NamedSweep> list = {
      {"tiled", Sweep::tiled},         {"sequential", Sweep::sequential},
      {"symmetric", Sweep::symmetric}, {"jacobi", Sweep::jacobi},
      {"natural", Sweep::natural},     {"chains", Sweep::chains},
      {"multigrid", Sweep::multigrid}, {"tethered_chains", Sweep::tethered_chains},
  };
  return list;
}

std::string sweep_name(Sweep sweep) {
  for (const NamedSweep& one : sweeps())
    if (one.sweep == sweep) return one.name;
  return "automatic";
}

}  // namespace pliant
