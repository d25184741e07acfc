// Which blocks of the grid the kernels of each cell of particles reach.
#pragma once

#include "surface/sort_keys.h"
#include "surface/splats.h"

namespace pliant::surface {

struct ReachedBlocks {
  std::vector<std::uint64_t> keys;  ///< of the blocks, ascending
  std::vector<int> first;           ///< of each block's entries in `cells`; one more than blocks
  std::vector<Keyed> cells;         ///< ranges of cells, ascending for each block
};

/// The blocks of this side [m] that kernels reach, and those that a quarter of a grid cell more would, for rounding.
ReachedBlocks find_blocks(const Splats& splats, float side, float cell, Executor& executor);

}  // namespace pliant::surface
