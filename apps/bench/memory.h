// The memory of a cloth, measured as the high-water mark of a separate process (`pliant bench memory`).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant::bench {

/// The memory of a W1 cotton cloth with bending: resident bytes per particle, above those at the start of the process.
/// It includes memory that the allocator retains.
struct MemoryRow {
  int size = 0;  ///< N of an N x N cloth
  Sweep sweep = Sweep::tiled;
  double scene = 0;            ///< memory after the Scene was made
  double scene_peak = 0;       ///< peak while the Scene is made, with the mesh
  double peak = 0;             ///< peak while Scene and World are made and two frames are simulated; the Scene is kept
  double peak_given_away = 0;  ///< the same peak if the Scene is given to the World
  double world = 0;            ///< memory of the World alone, after these frames
};

struct MemoryOptions {
  std::vector<int> sizes{512};
  std::vector<Sweep> sweeps{Sweep::tiled, Sweep::multigrid};
  std::function<void(const MemoryRow&)> on_row;
};

/// Measures each size. Throws an Error except on Linux, which alone reports a process's memory, or if a size is outside
/// 2..4096.
std::vector<MemoryRow> measure_memory(const MemoryOptions& options);

/// The memory that the World of a scene takes once it has made two steps, in a process of its own that has stepped a
/// small scene before; Linux alone [bytes].
double measure_bytes(const std::function<Scene()>& small, const std::function<Scene()>& scene);

std::string to_json(const std::vector<MemoryRow>& rows);

}  // namespace pliant::bench
