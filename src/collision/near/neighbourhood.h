// What is near what, as kept over substeps: clusters, pairs of clusters, near lists and static pairs.
//
// Plain data: NearLists keeps it up to date, the stages after it (contacts, filter) read it and lower or renew its bounds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/cluster_pairs.h"
#include "collision/near/static_pairs.h"

namespace pliant {

/// A pair of a near list.
struct NearPair {
  std::array<std::int32_t, 4> vertex{};  ///< of a vertex and a triangle, or of two edges, that of the lower number first
  float kept = -1;                       ///< what its distance at rest allows it to keep [m]; below 0: not measured
};

/// The pairs of two clusters that were near when the list was made. They are all that can be until `complete` is spent.
struct NearList : ClusterSides {
  Bound complete{-1, 0};
  Bound least{0, 0};  ///< of all pairs
  std::vector<NearPair> pairs{};
  std::vector<float> value{};  ///< of each pair, a Bound's, since `least` was [m]

  void clear(const Odometer& odometer);
};

/// A unit of work for threads.
struct NearTask {
  int first = 0, last = 0;  ///< near lists
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
  std::vector<NearTask> tasks;

  const ClusterPair& pair_of(const ClusterSides& sides) const { return pairs[sides.pair]; }
  const Odometer& odometer(const ClusterSides& sides) const { return pair_of(sides).odometer; }
};

/// Sixteen pairs that may become contacts, or be limited.
struct PairLanes {
  PairStencils stencils;
  PairBatch at;
  PairPaths paths;

  PairStencil pair(int lane, bool of_vertices) const {
    const auto& v = stencils.vertex;
    return {{v[0][lane], v[1][lane], v[2][lane], v[3][lane]}, of_vertices ? 1 : 2};
  }
  void set(std::size_t lane, const std::array<std::int32_t, 4>& vertex) {
    for (std::size_t k = 0; k < 4; ++k) stencils.vertex[k][lane] = vertex[k];
  }
};

/// Whether a cluster is so far from the origin that the rounding of its positions is as large as its edges. Contact and filter leave it
/// out: every pair of its edges would be within the filter's margin.
bool is_too_far(const Neighbourhood& near, int cluster);
inline bool is_too_far(const Neighbourhood& near, const ClusterSides& sides) {
  return is_too_far(near, sides.first) || is_too_far(near, sides.second);
}

/// The distance that the filter keeps between two clusters [m].
float filter_margin(const Neighbourhood& near, const ClusterSides& sides);

/// Pairs nearer than this are of interest to contacts or the filter. It allows for rounding as long as no cluster has gone far
/// (ClusterMotions::has_gone_far): for twice its extent at the last broad-phase rebuild.
float activation_distance(const Neighbourhood& near, const ClusterSides& sides);

/// By how much the distances of sixteen pairs fall at most in this substep, and how far apart their paths are.
void find_paths(const Neighbourhood& near, const ClusterSides& sides, const PairParticles& particles, PairLanes& lanes);

/// Collects the numbers of the list's pairs that can be nearer than `within` at the substep's end, ascending; `least` becomes that of
/// all others, or stays.
void collect_near(const Neighbourhood& near, NearList& list, float within, std::vector<std::int32_t>& found);

}  // namespace pliant
