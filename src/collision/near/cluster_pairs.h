// Pairs of near clusters, and upper bounds of how much distances between them can decrease.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/static_pairs.h"

namespace pliant {

/// Two near clusters, or one with itself.
struct ClusterPair {
  int a, b;  ///< a <= b
  PairMaterial material{};
  float rigid = 0;  ///< how much the rigid motions of both can reduce a distance in this substep [m]
  Odometer odometer{};
  bool is_joined = false;  ///< on one surface: a cluster with itself, or two with static pairs

  /// Measures `rigid` and the odometer's next.
  void measure(const ClusterMotions& motions);
};

class ClusterPairs {
 public:
  explicit ClusterPairs(const PairModel& model) : model_(model), boxes_(static_cast<std::size_t>(model.clusters)) {}

  /// Finds pairs that can come within the radius before a cluster travels travel(), and those of all static groups.
  void find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups);
  void measure(const ClusterMotions& motions);
  /// Advances the odometers; call it after the substep.
  void advance();

  /// How far a cluster may travel before the next broad-phase rebuild [m].
  float travel() const;
  const std::vector<ClusterPair>& pairs() const { return pairs_; }
  const ClusterPair& operator[](int number) const { return pairs_[static_cast<std::size_t>(number)]; }
  /// The index of an existing pair, in either order.
  int number_of(int a, int b) const;

 private:
  const PairModel& model_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  std::vector<ClusterPair> pairs_;  ///< ascending
};

}  // namespace pliant
