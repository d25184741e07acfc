// The field whose level is the surface: the sum of all kernels at the nodes of a sparse grid. It is about 1 inside and 0 outside.
//
// Blocks of 8 x 8 x 8 nodes exist only where kernels reach. Blocks deep inside the liquid have the value 1 everywhere and no storage.
#pragma once

#include <array>
#include <vector>

#include "surface/splats.h"

namespace pliant::surface {

inline constexpr int block_side = 8;  ///< nodes along an axis
inline constexpr int block_rows = block_side * block_side;
/// At a flat surface half the sum would be right if all kernels had one size. Those at the surface are smaller, so at this level the
/// surface lies half a spacing above the outermost particles of a lattice, within a fiftieth of a spacing.
inline constexpr float surface_level = 0.54f;

/// The values of a block's nodes, by z, y and x.
using BlockValues = std::array<float, block_side * block_rows>;

struct Field {
  float cell = 0;                   ///< side of a grid cell [m]; node (i, j, k) is at (i, j, k) * cell
  std::vector<std::uint64_t> keys;  ///< of the blocks, ascending
  KeyTable table;                   ///< from keys to blocks
  std::vector<int> stored;          ///< where each block's values are; -1: the value is 1 everywhere
  std::vector<BlockValues> values;

  int size() const { return static_cast<int>(keys.size()); }
  /// The value at node `node` (0..511) of a block.
  float at(int block, int node) const {
    const int place = stored[static_cast<std::size_t>(block)];
    return place < 0 ? 1.f : values[static_cast<std::size_t>(place)][static_cast<std::size_t>(node)];
  }
};

/// Makes the field. Each node whose value is not zero has blocks for all cells around it.
Field make_field(const ParticleCells& cells, const Splats& splats, float cell, Executor& executor);

}  // namespace pliant::surface
