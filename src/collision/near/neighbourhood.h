// Proximity data kept over substeps: clusters, cluster pairs, near lists and static pairs.
//
// It is plain data: NearLists updates it; contact detection and the filter read it, and update its distance bounds.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/cluster_pairs.h"
#include "collision/near/static_pairs.h"
#include "model/pool.h"

namespace pliant {

/// Sixteen pairs of a near list: vertices with triangles, or edges with edges, the lower edge first.
struct NearBlock {
  PairStencils stencils;
  std::array<float, 16> kept;         ///< contact distance that the distance at rest permits [m]; < 0: not computed yet
  std::array<std::int32_t, 16> rank;  ///< position in the order of contacts, ascending by row and column of the search
};

/// The near pairs of two clusters. The list contains all near pairs until motion exceeds the bound `complete`. Blocks
/// hold pairs of similar distance, so that far blocks are skipped whole.
struct NearList : ClusterSides {
  Bound complete{-1, 0};
  Bound least{0, 0};  ///< smallest distance bound of all blocks
  int pairs = 0;
  AlignedVector<NearBlock> blocks{};
  std::vector<float> value{};  ///< smallest distance bound of each block at the odometer total least.since [m]

  void clear(const Odometer& odometer);
  /// The number of pairs in a block; its remaining lanes repeat a pair.
  int pairs_in(std::size_t block) const { return std::min(16, pairs - 16 * static_cast<int>(block)); }
};

/// A range of near lists and a range of static groups: a unit of work for threads.
struct NearTask {
  int first = 0, last = 0;  ///< first and one past the last, in Neighbourhood::order
  int first_group = 0, last_group = 0;
};

struct Neighbourhood {
  const PairModel& model;
  const PairKernels& kernels;
  ClusterLayout layout;
  ClusterMotions motions;
  ClusterPairs pairs;
  StaticPairs static_pairs;
  std::vector<NearList> lists;
  /// Indices of lists in use: vertex-triangle lists, then edge-edge lists, by clusters.
  std::vector<std::int32_t> order;
  std::vector<NearTask> tasks;

  Neighbourhood(const PairModel& of, const PairKernels& with)
      : model(of), kernels(with), motions(of, with), pairs(of) {}

  const ClusterPair& pair_of(const ClusterSides& sides) const { return pairs[sides.pair]; }
  const Odometer& odometer(const ClusterSides& sides) const { return pair_of(sides).odometer; }
};

/// Sixteen pairs that may become contacts or need step limits.
struct PairLanes {
  PairStencils stencils;
  PairBatch at;
  PairPaths paths;

  PairStencil pair(int lane, bool of_vertices) const {
    const auto& v = stencils.vertex;
    return {{v[0][lane], v[1][lane], v[2][lane], v[3][lane]}, of_vertices ? 1 : 2};
  }
};

/// Lower limit of the filter's margin, in roundings of the positions.
inline constexpr float least_margin_roundings = 32;

/// True if the cluster is so far from the origin that position rounding reaches its edge length. Contact and filter
/// skip it, because every pair of its edges would be within the filter's margin.
inline bool is_too_far(const Neighbourhood& near, int cluster) {
  const std::vector<float>& coarsest = near.model.coarsest;
  return !coarsest.empty() && least_margin_roundings * one_rounding * near.motions[cluster].extent >
                                  coarsest[static_cast<std::size_t>(cluster)];
}
inline bool is_too_far(const Neighbourhood& near, const ClusterSides& sides) {
  return is_too_far(near, sides.first) || is_too_far(near, sides.second);
}

/// The distance that the filter maintains between two clusters [m].
inline float filter_margin(const Neighbourhood& near, const ClusterSides& sides) {
  constexpr float share_of_thickness = 0.05f;
  const float extent = max(near.motions[sides.first].extent, near.motions[sides.second].extent);
  return max(share_of_thickness * near.pair_of(sides).material.thickness,
             least_margin_roundings * one_rounding * extent);
}

/// The distance below which a pair is processed for contacts or the filter [m]. It allows for rounding until a cluster
/// is twice as far from the origin as at the last broad-phase rebuild (ClusterMotions::has_gone_far).
float activation_distance(const Neighbourhood& near, const ClusterSides& sides);

/// Computes upper bounds of the decrease of sixteen distances in this substep, and separations of the swept boxes.
void find_paths(const Neighbourhood& near, const ClusterSides& sides, const PairParticles& particles, PairLanes& lanes);

}  // namespace pliant
