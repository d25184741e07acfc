// Which clusters are near one another, and by how much distances between two of them can have fallen.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_motions.h"
#include "collision/near/static_pairs.h"

namespace pliant {

/// Two clusters that are near one another, or one and itself.
struct ClusterPair {
  int a, b;  ///< a <= b
  PairMaterial material{};
  float rigid = 0;  ///< by how much the rigid motions of both let a distance fall in this substep [m]
  Odometer odometer{};
  bool is_joined = false;  ///< of one surface: a cluster and itself, or two with static pairs between them

  /// Measures `rigid` and the odometer's next.
  void measure(const ClusterMotions& motions);
};

class ClusterPairs {
 public:
  explicit ClusterPairs(const PairModel& model) : model_(model), boxes_(static_cast<std::size_t>(model.clusters)) {}

  /// Finds all pairs that may come within the model's radius while no cluster travels farther than travel(), and all of static groups.
  void find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups);
  void measure(const ClusterMotions& motions);
  /// After the substep: it has been made.
  void advance();

  /// How far a cluster may travel before the next broad-phase rebuild [m].
  float travel() const;
  const std::vector<ClusterPair>& pairs() const { return pairs_; }
  const ClusterPair& operator[](int number) const { return pairs_[static_cast<std::size_t>(number)]; }
  /// The number of a pair that there is, in any order.
  int number_of(int a, int b) const;

 private:
  const PairModel& model_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  std::vector<ClusterPair> pairs_;  ///< ascending
};

}  // namespace pliant
