// The list of phases that an iteration visits. A phase is a driver and tasks without shared points, which threads run
// in any order. Each object is compiled to phases on its own; the merged list of the model is sorted by driver, then by
// colour. The drivers and the walk over the list are in solver/drivers. A new kind of matter adds a driver there and a
// value here. The walk and the other drivers stay as they are.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

/// The function that projects a phase's tasks. Values are in the order of execution within an iteration.
enum class Driver : std::int32_t {
  tile,              ///< constraints inside a tile, in SIMD lanes; a task is a tile
  inter_tile,        ///< constraints between tiles, in SIMD lanes; a task is a segment
  chain,             ///< paths solved directly; a task is a ChainBatch
  volume,            ///< global volume constraints; a task is an object
  stencil,           ///< constraints projected one at a time; a task is a segment
  tether,            ///< upper bounds of distances to pins; a task is an object
  surface_contact,   ///< contacts between surfaces, found in each substep; no tasks
  collider_contact,  ///< contacts with colliders, found in each substep; no tasks
};
inline constexpr int driver_count = 8;

/// Items [first, last) of one object that share no point.
struct ObjectPhase {
  Driver driver = Driver::tile;
  int first = 0, last = 0;
};

/// One item of one object: a tile, segment, ChainBatch or the object itself, depending on the driver.
struct Task {
  int object = 0, item = 0;
  int work = 0;  ///< estimated cost in batches or chain steps: decides whether threads pay off
};

/// The tasks of one driver and colour, over all objects.
struct Phase {
  Driver driver = Driver::tile;
  int colour = 0;             ///< index among the phases of this driver
  std::vector<Task> tasks{};  ///< ordered by object
  int work = 0;               ///< sum of the work of all tasks
};

}  // namespace pliant
