// Static neighbour pairs: pairs of primitives connected by one mesh edge.
//
// Most primitives near a piece of cloth are its mesh neighbours. These pairs never change, so they are listed once, in
// blocks of sixteen, and the search excludes them.
#pragma once

#include <algorithm>
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
  int pairs = 0;
  std::vector<PairStencils, CacheLineAllocator<PairStencils>> blocks{};
  std::vector<float> value{};  ///< the bound of each block, relative to the since of `least` [m]
  Bound least{};               ///< least bound of all blocks

  /// Rebases all bounds to the odometer's current total.
  void rebase(const Odometer& odometer);
  /// Resets all bounds to not measured.
  void forget();
  /// The number of valid pairs in a block; the remaining lanes repeat the last.
  int pairs_in(std::size_t block) const { return std::min(16, pairs - 16 * static_cast<int>(block)); }
};

struct StaticPairs {
  std::vector<StaticGroup> groups;  ///< groups of vertices and triangles first, then of edges, each sorted by clusters
  std::int64_t count = 0;

  /// Drops the groups of removed clusters.
  void remove(const std::vector<char>& is_removed);
};

/// Finds the static pairs of bodies, which have none yet, and their clusters' exclusions. Also adds to `clearance` those that meet
/// themselves.
void add_static_pairs(const PairModel& model, const std::vector<int>& bodies, ClusterLayout& layout, StaticPairs& to,
                      Clearance& clearance);

/// The stencil of a vertex and a triangle, or of two edges.
PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b);

}  // namespace pliant
