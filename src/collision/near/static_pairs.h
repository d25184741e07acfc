// Static neighbour pairs: pairs of primitives connected by one mesh edge.
//
// Most primitives near a piece of cloth are its mesh neighbours. These pairs never change, so they are listed once, in
// blocks of sixteen, and the search excludes them.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/bound.h"
#include "collision/near/clearance.h"
#include "collision/near/cluster_layout.h"
#include "parallel/executor.h"

namespace pliant {

/// Two clusters and the kind of their pairs: vertices of the first against triangles of the second, or edges.
struct ClusterSides {
  int first = 0, second = 0;
  bool of_vertices = false;
  int pair = -1;  ///< index of their ClusterPair
};

/// The static pairs of two clusters.
struct StaticGroup : ClusterSides {
  int first_block = 0, last_block = 0, pairs = 0;
  Bound least;  ///< least bound of all blocks
};

struct StaticPairs {
  std::vector<StaticGroup> groups;
  std::vector<PairStencils, CacheLineAllocator<PairStencils>> blocks;
  std::vector<float> value;  ///< the bound of each block, relative to the since of its group's `least` [m]
  std::int64_t count = 0;

  /// Rebases all bounds of a group to the odometer's current total.
  void rebase(StaticGroup& group, const Odometer& odometer);
  /// The number of valid pairs in a block; the remaining lanes repeat the last.
  static int pairs_in(const StaticGroup& group, int block) {
    const int left = group.pairs - 16 * (block - group.first_block);
    return left < 16 ? left : 16;
  }
};

/// Also fills the layout's exclusions, and `joined` with adjacent vertices in both directions, for Clearance.
StaticPairs find_static_pairs(const PairModel& model, ClusterLayout& layout, std::vector<Clearance::Line>& joined);

/// The clusters as pieces for Clearance.
std::vector<Clearance::Piece> clearance_pieces(const PairModel& model, const ClusterLayout& layout);

/// The stencil of a vertex and a triangle, or of two edges.
PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b);

}  // namespace pliant
