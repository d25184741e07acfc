// The field whose level is the surface: the sum of all kernels at the nodes of a sparse grid. It is about 1 inside and
// 0 outside.
//
// Blocks of 8 x 8 x 8 nodes exist only where kernels reach. Of the eight bricks of 4 x 4 x 4 nodes in a block, those
// that no kernel reaches are 0 everywhere, those deep inside the liquid are 1, and neither has storage.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "surface/splats.h"

namespace pliant::surface {

inline constexpr int block_side = 8;  ///< nodes along an axis
inline constexpr int block_bricks = 8;
/// At a flat surface half the sum would be right if all kernels had one size. Those at the surface are smaller, so at
/// this level the surface lies half a spacing above the outermost particles of a lattice, within a fiftieth of a
/// spacing.
inline constexpr float surface_level = 0.54f;

/// A bit for each node of a brick, by z, y and x.
using NodeSet = std::uint64_t;

/// A block's bricks, by z, y and x.
struct FieldBlock {
  std::array<NodeSet, block_bricks> inside{};       ///< nodes above surface_level
  std::array<const float*, block_bricks> values{};  ///< of each node of a brick
  std::unique_ptr<float[]> storage;                 ///< of the bricks that have some
};

struct Field {
  float cell = 0;                   ///< side of a grid cell [m]; node (i, j, k) is at (i, j, k) * cell
  std::vector<std::uint64_t> keys;  ///< of the blocks, ascending
  KeyTable table;                   ///< from keys to blocks
  std::vector<FieldBlock> blocks;

  int size() const { return static_cast<int>(keys.size()); }
  /// The value at node `node` (0..511) of a block, by z, y and x.
  float at(int block, int node) const;
};

/// The values of a brick without kernels.
const float* empty_brick();

/// Makes the field. Each node above surface_level has blocks for all cells around it.
Field make_field(const ParticleCells& cells, const Splats& splats, float cell, Executor& executor,
                 const SurfaceKernels& kernels = best_kernels());

}  // namespace pliant::surface
