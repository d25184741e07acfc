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

/// Two clusters and the kind of pairs: vertices of `first` with triangles of `second`, or edges of both.
struct ClusterSides {
  int first = 0, second = 0;
  bool of_vertices = false;
  int pair = -1;  ///< index of the ClusterPair of the two clusters
};

/// The static pairs of two clusters and of one kind.
struct StaticGroup : ClusterSides {
  int pairs = 0;
  std::vector<PairStencils, CacheLineAllocator<PairStencils>> blocks{};
  std::vector<float> value{};  ///< distance bound of each block at the odometer total least.since [m]
  Bound least{};               ///< smallest distance bound of all blocks

  /// Reduces all bounds by what the odometer has counted, and sets their `since` to its current total.
  void rebase(const Odometer& odometer);
  /// Marks all bounds as not measured.
  void forget();
  /// The number of pairs in a block; its remaining lanes repeat the last pair.
  int pairs_in(std::size_t block) const { return std::min(16, pairs - 16 * static_cast<int>(block)); }
};

struct StaticPairs {
  std::vector<StaticGroup> groups;  ///< vertex-triangle groups, then edge-edge groups, each sorted by clusters
  std::int64_t count = 0;

  /// Removes the groups of removed clusters.
  void remove(const std::vector<char>& is_removed);
};

/// Finds the static pairs of bodies that have none yet, and sets which columns the search excludes for them. Adds
/// bodies with self-contact to `clearance`.
void add_static_pairs(const PairModel& model, const std::vector<int>& bodies, ClusterLayout& layout, StaticPairs& to,
                      Clearance& clearance);

/// Makes the stencil of a vertex and a triangle, or of two edges.
PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b);

}  // namespace pliant
