// What an iteration visits, as one list. A phase is a driver and tasks that share nothing: all threads take them in any order. An
// object's phases are made from that object alone; those of a model are their merge, driver after driver, and of each driver colour
// after colour. The walk over the list and the drivers are in solver/drivers; a new kind of matter adds a driver there and its phases
// here, and changes neither the walk nor another driver.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

/// What projects a phase's tasks, in the order in which an iteration comes by.
enum class Driver : std::int32_t {
  tile,              ///< constraints inside a tile, in lanes; a task is a tile
  inter_tile,        ///< constraints between tiles, in lanes; a task is a segment
  chain,             ///< paths solved directly; a task is a ChainBatch
  volume,            ///< a volume; a task is an object
  stencil,           ///< what is projected one constraint at a time; a task is a segment
  tether,            ///< upper bounds of distances to pins; a task is an object
  surface_contact,   ///< contacts among surfaces, which are found in each substep: no tasks
  collider_contact,  ///< contacts of each tile with colliders, likewise
};
inline constexpr int driver_count = 8;

/// Items [first, last) of one object that share nothing.
struct ObjectPhase {
  Driver driver = Driver::tile;
  int first = 0, last = 0;
};

/// One item of one object.
struct Task {
  int object = 0, item = 0;
  int work = 0;  ///< batches, or steps of a chain: what tells whether threads are worth their while
};

/// Phases of one driver and colour, over all objects.
struct Phase {
  Driver driver = Driver::tile;
  int colour = 0;             ///< how many phases of the driver come before it in each object
  std::vector<Task> tasks{};  ///< in the order of their objects' numbers
  int work = 0;               ///< of all tasks
};

}  // namespace pliant
