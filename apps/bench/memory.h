// The memory of a cloth, from the high-water mark of a separate process (`pliant bench memory`).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant::bench {

/// Figures of one W1 cotton cloth with bending: resident bytes per particle above the process's initial memory. They
/// include memory that the allocator retains.
struct MemoryRow {
  int size = 0;  ///< N of an N x N cloth
  Sweep sweep = Sweep::tiled;
  double scene = 0;            ///< the Scene alone
  double scene_peak = 0;       ///< peak while the Scene is made, including the mesh
  double peak = 0;             ///< peak while Scene and World are made and two frames stepped, with the Scene kept
  double peak_given_away = 0;  ///< the same with the Scene given to the World
  double world = 0;            ///< the World alone, after these frames
};

struct MemoryOptions {
  std::vector<int> sizes{512};
  std::vector<Sweep> sweeps{Sweep::tiled, Sweep::multigrid};
  std::function<void(const MemoryRow&)> on_row;
};

/// Only Linux reports a process's memory: throws an Error elsewhere, or if a size is outside 2..4096.
std::vector<MemoryRow> measure_memory(const MemoryOptions& options);

std::string to_json(const std::vector<MemoryRow>& rows);

}  // namespace pliant::bench
