// Phases: the list that an iteration visits. A phase is a driver and tasks that share no points, so that threads run
// them in any order. Each object is compiled to phases on its own. The model's list merges them, sorted by driver, then
// by colour. solver/drivers has the drivers and the walk over the list. A new kind of matter adds a driver there and a
// value here; nothing else changes.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

/// Names the function that projects a phase's tasks. The values are in the order of execution within an iteration.
enum class Driver : std::int32_t {
  tile,              ///< constraints inside a tile, in SIMD lanes; a task is a tile
  inter_tile,        ///< constraints between tiles, in SIMD lanes; a task is a segment
  held,              ///< springs of held particles (model/held_particles.h); a task is an object
  chain,             ///< paths solved directly; a task is a ChainBatch
  volume,            ///< global volume constraints; a task is an object
  stencil,           ///< constraints projected one at a time; a task is a segment
  cluster,           ///< shape matching, in colours; a task is a cluster
  tether,            ///< upper bounds of distances to pins; a task is an object
  surface_contact,   ///< contacts between surfaces, found in each substep; no tasks
  collider_contact,  ///< contacts with colliders, found in each substep; no tasks
};
inline constexpr int driver_count = 10;

/// Items [first, last) of one object. They share no point.
struct ObjectPhase {
  Driver driver = Driver::tile;
  int first = 0, last = 0;
};

/// One item of one object: a tile, a segment, a ChainBatch or the object itself, depending on the driver.
struct Task {
  int object = 0, item = 0;
  int work = 0;  ///< estimated cost in batches or chain steps; little work runs on one thread
};

/// The tasks of one driver and colour, over all objects.
struct Phase {
  Driver driver = Driver::tile;
  int colour = 0;             ///< number of the phase among those of its driver
  std::vector<Task> tasks{};  ///< tasks of all objects, ordered by object
  int work = 0;               ///< sum of the work of all tasks
};

}  // namespace pliant
