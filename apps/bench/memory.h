// How much memory a cloth takes, from the high-water mark of a process of its own. `pliant bench memory` prints it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant::bench {

/// Of one W1 cloth of cotton with bending, in bytes a particle above what the process took before. Resident memory, what the allocator
/// holds back included.
struct MemoryRow {
  int size = 0;  ///< N of an N x N cloth
  Sweep sweep = Sweep::tiled;
  double scene = 0;       ///< the Scene alone
  double scene_peak = 0;  ///< while it is made, mesh included
  double peak =
      0;  ///< while Scene and World are made and two frames stepped, the Scene being kept: the figure that is promised
  double world = 0;  ///< the World alone, after these frames
};

struct MemoryOptions {
  std::vector<int> sizes{512};
  std::vector<Sweep> sweeps{Sweep::tiled, Sweep::multigrid};
  std::function<void(const MemoryRow&)> on_row;
};

/// Linux alone says how much a process takes: throws Error elsewhere, and where a size is out of 2..4096.
std::vector<MemoryRow> measure_memory(const MemoryOptions& options);

std::string to_json(const std::vector<MemoryRow>& rows);

}  // namespace pliant::bench
