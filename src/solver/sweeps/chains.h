// The chain sweep: which paths of distance constraints are solved exactly, and in which order; tethers follow.
//
// Gauss-Seidel propagates a force by one edge per pass, so finely meshed cloth that hangs from two corners needs
// thousands of passes. Solving whole rows, columns and diagonals exactly propagates it from end to end in one pass.
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/substep.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

struct ChainScratch : SweepScratch {
  std::vector<AlignedVector<float>> of_thread;  ///< scratch array of each thread, for the longest chain

  void prepare(const SweepSetup& setup, int object) override;
};

}  // namespace pliant
