// Pairs of near clusters, and upper bounds of how much distances between them can decrease.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/broad/tree.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/static_pairs.h"

namespace pliant {

/// Two near clusters, or one with itself.
struct ClusterPair {
  int a, b;  ///< clusters in the order of PairModel::is_before, or equal; -1: not in use
  PairMaterial material{};
  float rigid = 0;  ///< how much the rigid motions of both can reduce a distance in this substep [m]
  Odometer odometer{};
  bool is_joined = false;  ///< on one surface: a cluster with itself, or two with static pairs

  /// Measures `rigid` and the odometer's next.
  void measure(const ClusterMotions& motions);
};

class ClusterPairs {
 public:
  explicit ClusterPairs(const PairModel& model) : model_(model) {}

  /// Finds pairs that can come within the radius before a cluster travels travel(), and those of all static groups.
  void find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups);
  /// Finds the pairs of new clusters with each other and all others, and those of groups without a pair. Returns their
  /// indices. The others may have travelled up to travel(), the new ones not at all.
  std::vector<int> find_of_new(const std::vector<int>& clusters, const ClusterMotions& motions,
                               const std::vector<StaticGroup>& groups);
  /// Drops the pairs of removed clusters.
  void remove(const std::vector<char>& is_removed);
  void measure(const ClusterMotions& motions);
  /// Advances the odometers; call it after the substep.
  void advance();

  /// How far a cluster may travel before the next broad-phase rebuild [m].
  float travel() const;
  /// Sorted after find(); pairs added later take unused places.
  const std::vector<ClusterPair>& pairs() const { return pairs_; }
  const ClusterPair& operator[](int number) const { return pairs_[static_cast<std::size_t>(number)]; }
  /// Finds an existing pair among indices sorted by clusters.
  int number_of(const StaticGroup& group, const std::vector<int>& among) const;
  /// The indices of all pairs after find().
  std::vector<int> numbers() const;

 private:
  using Clusters = std::pair<int, int>;
  /// Orders pairs by the ranks of their clusters.
  std::uint64_t key_of(const Clusters& pair) const {
    return std::uint64_t{rank_[static_cast<std::size_t>(pair.first)]} << 32 | rank_[static_cast<std::size_t>(pair.second)];
  }
  void add_if_they_meet(int a, int b, std::vector<Clusters>& to) const;
  void sort(std::vector<Clusters>& pairs) const;
  void fit_boxes(const ClusterMotions& motions);
  void mark_joined(const std::vector<StaticGroup>& groups, const std::vector<int>& among, bool only_new);
  ClusterPair make(const Clusters& clusters) const;

  const PairModel& model_;
  std::vector<BoxBounds> boxes_;     ///< grown boxes of the clusters in use, in their order
  std::vector<std::uint32_t> rank_;  ///< the place of each cluster in that order, which is that of PairModel::is_before
  Tree<BoxBounds> tree_;
  std::vector<ClusterPair> pairs_;
};

}  // namespace pliant
