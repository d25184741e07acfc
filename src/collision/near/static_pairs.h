// Static neighbour pairs: pairs with one edge of the mesh between them.
//
// Most of what is near a piece of cloth is the cloth around it. These pairs never change, so they are listed once, in blocks of sixteen;
// the search for other pairs leaves them out.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/bound.h"
#include "collision/near/clearance.h"
#include "collision/near/cluster_layout.h"
#include "parallel/executor.h"

namespace pliant {

/// Two clusters and the kind of pairs between them: a vertex of the first and a triangle of the second, or two edges.
struct ClusterSides {
  int first = 0, second = 0;
  bool of_vertices = false;
  int pair = -1;  ///< number of the two clusters' ClusterPair
};

/// The static pairs of two clusters.
struct StaticGroup : ClusterSides {
  int first_block = 0, last_block = 0, pairs = 0;
  Bound least;  ///< of all blocks
};

struct StaticPairs {
  std::vector<StaticGroup> groups;
  std::vector<PairStencils, CacheLineAllocator<PairStencils>> blocks;
  std::vector<float> value;  ///< of each block, a Bound's, since its group's `least` was [m]
  std::int64_t count = 0;

  /// Takes the odometer's total as the new beginning of all bounds of a group.
  void rebase(StaticGroup& group, const Odometer& odometer);
  /// How many pairs of a block count; the rest repeats the last.
  static int pairs_in(const StaticGroup& group, int block) {
    const int left = group.pairs - 16 * (block - group.first_block);
    return left < 16 ? left : 16;
  }
};

/// Also tells the layout what to leave out, and gives the vertices that are joined by an edge, both ways about, for Clearance.
StaticPairs find_static_pairs(const PairModel& model, ClusterLayout& layout, std::vector<Clearance::Line>& joined);

/// The clusters as Clearance needs them.
std::vector<Clearance::Piece> clearance_pieces(const PairModel& model, const ClusterLayout& layout);

/// The stencil of a vertex and a triangle, or of two edges.
PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b);

}  // namespace pliant
