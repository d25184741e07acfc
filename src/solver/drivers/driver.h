// The walk over a model's phases (model/phase.h), and what a driver is: a function that projects the tasks of one phase. Drivers are a
// file each; drivers.cpp has their table. A new one is a value of Driver, a file and a line of the table.
#pragma once

#include "model/phase.h"
#include "solver/substep.h"

namespace pliant {

/// Which way the list is walked.
enum class Order { forward, backward };

/// Where in an iteration a driver has its turn (stages/solve.cpp).
enum class Turn {
  sweep,    ///< for each group of objects, as its sweep method has it
  stencil,  ///< after all groups
  last,     ///< tethers, then contacts, so that constraints pull no particle into a collider
};

struct Pass {
  bool first = false;  ///< multipliers start at zero
  Order order = Order::forward;
  int number = 0;  ///< of the passes over stencils in this iteration
};

struct PhaseDriver {
  Turn turn;
  bool has_order;  ///< a backward walk projects its phases, too, in the reverse order
  void (*project)(Substep& s, const Phase& phase, const Pass& pass);
};

const PhaseDriver& driver_of(const Phase& phase);

/// Projects all phases whose drivers have that turn once; or those of one driver.
void walk(Substep& s, Turn turn, const Pass& pass);
void walk(Substep& s, Driver driver, const Pass& pass);

/// Calls body(task) for the tasks of objects that are swept (is_swept), on all threads where the phase has `fewest_to_share` batches or
/// steps: with less, waking them takes longer.
void for_tasks(Substep& s, const Phase& phase, const char* name, int fewest_to_share, FunctionRef<void(const Task&)> body);

void project_tiles(Substep& s, const Phase& phase, const Pass& pass);              // lanes.cpp
void project_inter_tile(Substep& s, const Phase& phase, const Pass& pass);         // lanes.cpp
void project_chains(Substep& s, const Phase& phase, const Pass& pass);             // chain.cpp
void project_volumes(Substep& s, const Phase& phase, const Pass& pass);            // volume.cpp
void project_stencils(Substep& s, const Phase& phase, const Pass& pass);           // stencil.cpp
void hold_tethers(Substep& s, const Phase& phase, const Pass& pass);               // tether.cpp
void project_surface_contacts(Substep& s, const Phase& phase, const Pass& pass);   // contacts.cpp
void project_collider_contacts(Substep& s, const Phase& phase, const Pass& pass);  // contacts.cpp

}  // namespace pliant
