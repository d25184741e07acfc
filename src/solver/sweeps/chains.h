// The chain sweep: which paths are solved when, and the tethers after them.
//
// Plain sweeps carry a pull one edge a pass, so what hangs from two corners needs passes by the thousand when it is finely
// meshed. Solving whole rows, columns and diagonals at once carries it from end to end in one.
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/substep.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

struct ChainScratch : SweepScratch {
  std::vector<AlignedVector<float>> of_thread;  ///< room for the longest chain each

  void prepare(const SweepSetup& setup, int object) override;
};

/// Solves all chains of the group once, colour after colour.
void solve_chains(Substep& s, bool first_pass);

/// Puts every particle back to within its tethers.
void hold_tethers(Substep& s);

}  // namespace pliant
