// The bricks of a block and of those above it, and the sets of nodes that are one step up from those of a brick.
#pragma once

#include "surface/field.h"

namespace pliant::surface {

/// The block itself and its seven neighbours above; bit a of the index means one block up along axis a. -1 where there
/// is none.
using Neighbours = std::array<int, 8>;

/// The neighbours of all blocks.
std::vector<Neighbours> find_neighbours(const Field& field, Executor& executor);

/// Bricks by z, y and x, three along each axis, as 8 block + brick; the first two along each are the block's own. -1
/// where there is none.
using BrickGrid = std::array<int, 27>;

BrickGrid bricks_above(const Neighbours& neighbours);

/// A value for a brick and for its seven neighbours above, in the order of Neighbours.
template <class Value>
using AroundBrick = std::array<Value, 8>;

/// The numbers of a brick and of its neighbours in the grid.
inline AroundBrick<int> around_brick(const BrickGrid& grid, int brick) {
  const int own = (brick & 1) + 3 * (brick >> 1 & 1) + 9 * (brick >> 2);
  AroundBrick<int> around{};
  for (int n = 0; n < 8; ++n) {
    const int at = own + (n & 1) + 3 * (n >> 1 & 1) + 9 * (n >> 2);
    around[static_cast<std::size_t>(n)] = grid[static_cast<std::size_t>(at)];
  }
  return around;
}

/// Of each node, whether the node one step up along x is in the set, which goes on in the brick above.
inline NodeSet up_x(NodeSet own, NodeSet above) {
  return (own >> 1 & 0x7777777777777777U) | (above << 3 & 0x8888888888888888U);
}
inline NodeSet up_y(NodeSet own, NodeSet above) {
  return (own >> 4 & 0x0fff0fff0fff0fffU) | (above << 12 & 0xf000f000f000f000U);
}
inline NodeSet up_z(NodeSet own, NodeSet above) { return own >> 16 | above << 48; }

/// The number of nodes in a set. Without the instruction for it, which not every level has, std::popcount is a call.
inline int size_of(NodeSet nodes) {
  nodes -= nodes >> 1 & 0x5555555555555555U;
  nodes = (nodes & 0x3333333333333333U) + (nodes >> 2 & 0x3333333333333333U);
  nodes = (nodes + (nodes >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<int>(nodes * 0x0101010101010101U >> 56);
}

/// By corner: the set of cells that have that corner inside. A cell is named after its first node.
using CornerSets = std::array<NodeSet, 8>;

inline CornerSets corner_sets(const AroundBrick<NodeSet>& inside) {
  CornerSets c;
  const NodeSet x_at_y = up_x(inside[2], inside[3]), x_at_z = up_x(inside[4], inside[5]),
                x_at_yz = up_x(inside[6], inside[7]);
  c[0] = inside[0];
  c[1] = up_x(inside[0], inside[1]);
  c[2] = up_y(inside[0], inside[2]);
  c[3] = up_y(c[1], x_at_y);
  c[4] = up_z(inside[0], inside[4]);
  c[5] = up_z(c[1], x_at_z);
  c[6] = up_z(c[2], up_y(inside[4], inside[6]));
  c[7] = up_z(c[3], up_y(x_at_z, x_at_yz));
  return c;
}

/// The cells whose corners are not all on one side.
inline NodeSet mixed_cells(const CornerSets& c) {
  const NodeSet any = c[0] | c[1] | c[2] | c[3] | c[4] | c[5] | c[6] | c[7];
  const NodeSet all = c[0] & c[1] & c[2] & c[3] & c[4] & c[5] & c[6] & c[7];
  return any & ~all;
}

/// The case of a cell.
inline unsigned case_of(const CornerSets& c, int cell) {
  unsigned inside = 0;
  for (unsigned corner = 0; corner < 8; ++corner) inside |= static_cast<unsigned>(c[corner] >> cell & 1U) << corner;
  return inside;
}

}  // namespace pliant::surface
