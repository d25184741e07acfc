// The ways to visit constraints, one file each. None is known to a constraint, and none knows a constraint's type: all work
// on the pools and the schedule of the compiled model, through the kernels.
//
// Volumes are part of a sweep; contacts come after it and after acceleration (solver/step.cpp), so that what is drawn does
// not reach into what it lies on.
#pragma once

#include "pliant/scene.h"

namespace pliant {

struct Substep;

struct SweepMethod {
  /// Its first pass over the constraints of a tile may be made when the tile is entered, while it is in the cache.
  bool begins_on_entry;
  /// Projections of a constraint in one iteration.
  int passes;
  /// One iteration: every constraint among particles `passes` times. In the first of a substep the multipliers start at
  /// zero.
  void (*iterate)(Substep& s, bool first);
};

/// What stands behind a Settings::sweep.
const SweepMethod& sweep_method(Sweep sweep);

void iterate_tiled(Substep& s, bool first);      // tiled.cpp
void iterate_symmetric(Substep& s, bool first);  // symmetric.cpp
void iterate_jacobi(Substep& s, bool first);     // jacobi.cpp
void iterate_chains(Substep& s, bool first);     // chains.cpp
void iterate_multigrid(Substep& s, bool first);  // multigrid.cpp

}  // namespace pliant
