// Pairs of near clusters, and upper bounds of how much distances between them can decrease.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/broad/tree.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/static_pairs.h"

namespace pliant {

/// Two near clusters; both may be the same one.
struct ClusterPair {
  int a, b;  ///< clusters in the order of PairModel::is_before, or equal; -1: not in use
  PairMaterial material{};
  float rigid = 0;  ///< upper bound of how much the rigid motions of both reduce a distance in this substep [m]
  Odometer odometer{};
  bool is_joined = false;  ///< true if both are on one surface: equal clusters, or two with static pairs

  /// Computes `rigid` and the odometer's count for this substep.
  void measure(const ClusterMotions& motions);
};

/// For each cluster, its pairs in the order of the other cluster. Clusters are given by position in cluster_order.
struct PairsOfClusters {
  struct Entry {
    int other;  ///< position of the other cluster in cluster_order
    int pair;
  };
  std::vector<int> start;  ///< for each cluster, the index of its first entry
  std::vector<Entry> entries;
};

class ClusterPairs {
 public:
  explicit ClusterPairs(const PairModel& model) : model_(model) {}

  /// Finds all pairs of clusters that can come within the radius before one travels travel(), and the pairs of all
  /// groups. Returns the index of each group's pair.
  std::vector<int> find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups);
  /// Finds the pairs of new clusters with each other and with old ones, and those of groups that have no pair. Returns
  /// the indices of the pairs found. Old clusters may have travelled up to travel() already.
  std::vector<int> find_of_new(const std::vector<int>& clusters, const ClusterMotions& motions,
                               const std::vector<StaticGroup>& groups);
  /// Removes the pairs of removed clusters.
  void remove(const std::vector<char>& is_removed);
  void measure(const ClusterMotions& motions);
  /// Advances the odometers; call it after the substep.
  void advance();

  /// How far a cluster may travel before the next broad-phase rebuild [m].
  float travel() const;
  /// All pairs. find() sorts them; find_of_new() reuses unused indices.
  const std::vector<ClusterPair>& pairs() const { return pairs_; }
  const ClusterPair& operator[](int number) const { return pairs_[static_cast<std::size_t>(number)]; }
  /// Returns the index of a group's pair; `among` lists indices of pairs, sorted by their clusters.
  int number_of(const StaticGroup& group, const std::vector<int>& among) const;
  /// Lists each pair at both of its clusters. `among`: indices of pairs, sorted by their clusters.
  PairsOfClusters by_cluster(const std::vector<int>& among) const;
  /// The indices of all pairs; call it after find() only.
  std::vector<int> numbers() const;

 private:
  using Clusters = std::pair<int, int>;
  /// A sort key of a pair: the ranks of its two clusters.
  std::uint64_t key_of(const Clusters& pair) const {
    return std::uint64_t{rank_[static_cast<std::size_t>(pair.first)]} << 32 |
           rank_[static_cast<std::size_t>(pair.second)];
  }
  void add_if_they_meet(int a, int b, std::vector<Clusters>& to) const;
  void sort(std::vector<Clusters>& pairs) const;
  void fit_boxes(const ClusterMotions& motions);
  std::vector<int> numbers_of(const std::vector<StaticGroup>& groups) const;
  ClusterPair make(const Clusters& clusters) const;

  const PairModel& model_;
  std::vector<BoxBounds> boxes_;     ///< swept boxes of the clusters in cluster_order, grown by radius and travel()
  std::vector<std::uint32_t> rank_;  ///< for each cluster, its position in cluster_order
  Tree<BoxBounds> tree_;
  std::vector<ClusterPair> pairs_;
};

}  // namespace pliant
