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
  std::vector<AlignedVector<float>> of_thread;  ///< scratch for the longest chain, one per thread

  void prepare(const SweepSetup& setup, int object) override;
};

}  // namespace pliant
