// The chain sweep: the order in which paths are solved, and the tethers after them.
//
// Gauss-Seidel carries a force one edge per pass, so finely meshed cloth that hangs from two corners needs thousands of
// passes. Solving whole rows, columns and diagonals at once carries it from end to end in one pass.
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/substep.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

struct ChainScratch : SweepScratch {
  std::vector<AlignedVector<float>> of_thread;  ///< room for the longest chain, for each thread

  void prepare(const SweepSetup& setup, int object) override;
};

/// Solves all chains of the group once, colour by colour.
void solve_chains(Substep& s, bool first_pass);

/// Projects every particle onto its tethers.
void hold_tethers(Substep& s);

}  // namespace pliant
