// Walks a model's phases (model/phase.h). A driver is a function that projects the tasks of one phase; each has its own
// file. A new driver needs a value of Driver, a file, and a line in the table of drivers.cpp.
#pragma once

#include <optional>

#include "model/phase.h"
#include "solver/substep.h"

namespace pliant {

/// The order in which a walk visits the phases.
enum class Order { forward, backward };

/// The part of an iteration in which a driver runs (stages/solve.cpp).
enum class Turn {
  sweep,    ///< once or more for each sweep group, as its sweep method requires
  stencil,  ///< after the sweeps of all groups
  last,     ///< at the end: tethers, then contacts, so that no constraint pulls a particle into a collider afterwards
};

struct Pass {
  bool first = false;  ///< the first pass of a substep: multipliers start at zero
  Order order = Order::forward;
  int number = 0;                           ///< index of this pass over the stencils within the iteration
  const std::vector<char>* only = nullptr;  ///< for each object, 1 if chains of it are solved; null: all
  /// For each object, 1 if project_ties has begun its ties in this substep; null: none.
  const std::vector<char>* tied = nullptr;
};

struct PhaseDriver {
  Turn turn;
  bool has_order;  ///< true if a backward walk visits these phases, in reverse order; false if it skips them
  void (*project)(Substep& s, const Phase& phase, const Pass& pass);
};

const PhaseDriver& driver_of(const Phase& phase);

/// Projects once all phases whose driver has this Turn, or all phases of one driver.
void walk(Substep& s, Turn turn, const Pass& pass);
void walk(Substep& s, Driver driver, const Pass& pass);
/// Projects the ties of particles to bodies of the objects with 1 in `of` that are solved by chains, before anything
/// else of a substep.
void project_ties(Substep& s, const std::vector<char>& of);

/// Calls body(task) for the tasks of objects whose sweep runs (is_swept). Uses all threads if the phase has at least
/// `fewest_to_share` batches or steps of work; with less, waking them takes longer than the work. The call is timed
/// under `name` unless that is null.
void for_tasks(Substep& s, const Phase& phase, const char* name, int fewest_to_share,
               FunctionRef<void(const Task&)> body);

/// Inter-tile colours with fewer batches run on one thread, because waking others takes longer.
inline constexpr int fewest_inter_tile_batches = 96;
inline constexpr const char* inter_tile_name = "solve: inter-tile constraints";

/// Times consecutive inter-tile colours on one thread as one interval: reading the clock takes as long as some batches.
class InterTileTimer {
 public:
  explicit InterTileTimer(Substep& s) : timings_(s.context.executor.timings()) {}
  /// Call it before each phase is projected.
  void enter(const Phase& phase);

 private:
  Timings& timings_;
  std::optional<Stopwatch> watch_;
};

void project_tiles(Substep& s, const Phase& phase, const Pass& pass);              // defined in lanes.cpp
void project_inter_tile(Substep& s, const Phase& phase, const Pass& pass);         // defined in lanes.cpp
void release_held(Substep& s, const Phase& phase, const Pass& pass);               // defined in held.cpp
void project_chains(Substep& s, const Phase& phase, const Pass& pass);             // defined in chain.cpp
void project_volumes(Substep& s, const Phase& phase, const Pass& pass);            // defined in volume.cpp
void project_stencils(Substep& s, const Phase& phase, const Pass& pass);           // defined in stencil.cpp
void project_clusters(Substep& s, const Phase& phase, const Pass& pass);           // defined in cluster.cpp
void hold_tethers(Substep& s, const Phase& phase, const Pass& pass);               // defined in tether.cpp
void project_surface_contacts(Substep& s, const Phase& phase, const Pass& pass);   // defined in contacts.cpp
void project_collider_contacts(Substep& s, const Phase& phase, const Pass& pass);  // defined in contacts.cpp

}  // namespace pliant
