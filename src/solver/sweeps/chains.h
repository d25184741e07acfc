// The chain sweep: which paths are solved when, and the tethers after them.
//
// Plain sweeps carry a pull one edge a pass, so what hangs from two corners needs passes by the thousand when it is finely
// meshed. Solving whole rows, columns and diagonals at once carries it from end to end in one.
#pragma once

#include "model/model.h"
#include "solver/substep.h"
#include "solver/sweeps/chain_kernels.h"

namespace pliant {

/// Room for the scratch of every thread and for the anchors.
void prepare_chains(const Model& model, int threads, Workspace& workspace);
/// The same for one object alone.
void prepare_chains(const Model& model, int object, int threads, Workspace& workspace);

/// Solves all chains once, colour after colour.
void solve_chains(Substep& s, bool first_pass);

/// Puts every particle back to within its tethers.
void hold_tethers(Substep& s);

}  // namespace pliant
