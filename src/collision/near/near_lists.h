// Keeps near lists (neighbour lists of primitives) up to date.
//
// A list is rebuilt on use, when the odometer of its two clusters has exhausted its skin. If the clearance or the cluster
// boxes prove that nothing is near, the list stays empty and no primitive is tested.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/box_search.h"
#include "collision/near/clearance_search.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

/// All near lists. Over thirty members: short steps over one set of lists, in near_lists.cpp, and in near_changes.cpp where
/// bodies come and go.
class NearLists {
 public:
  NearLists(const PairModel& model, const PairKernels& kernels);
  NearLists(const NearLists&) = delete;
  NearLists& operator=(const NearLists&) = delete;

  /// Removes bodies, given by their clusters, and adds new ones. Lists and bounds of all others are kept.
  void change(const PairChanges& changes);

  /// Forces a broad-phase rebuild; needed after positions change other than by the measured motion.
  void forget() { is_listed_ = false; }
  /// Measures the substep's motion. Returns true if every end position is finite
  /// and below 1e14 m. Otherwise nothing else may be called in this substep.
  bool measure(Executor& executor, const PairParticles& particles);
  /// Lists all pairs that can matter in this substep. Call it after measure().
  void update(Executor& executor, const PairParticles& particles);
  /// Advances the odometers by the measured motion; call it after the substep.
  void advance();

  Neighbourhood& neighbourhood() { return near_; }
  const Neighbourhood& neighbourhood() const { return near_; }
  std::int64_t candidates() const { return near_.static_pairs.count + listed_; }
  /// The number of broad-phase rebuilds.
  std::int64_t rebuilds() const { return rebuilds_; }

 private:
  /// Scratch memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> stale;
    BoxSearch::Scratch search;
  };

  float skin() const;
  void remove(const std::vector<int>& bodies, const std::vector<Block>& clusters);
  void add(const std::vector<int>& bodies);
  void resize();
  void pair_new_clusters();
  void add_lists(const std::vector<int>& pairs);
  void pair_clusters();
  void carry_groups(const std::vector<ClusterPair>& old);
  void make_lists(const std::vector<ClusterPair>& old);
  void cut_into_tasks();
  void find_stale();
  void drop_clear(Executor& executor, const PairParticles& particles);
  bool is_clear(NearList& list) const;
  void refresh(NearList& list, BoxSearch::Scratch& scratch, const PairParticles& particles);
  void keep_near(NearList& list, float within, BoxSearch::Scratch& scratch, const PairParticles& particles) const;

  Neighbourhood near_;
  ClearanceSearch clearance_;
  BoxSearch search_;
  std::vector<Scratch> scratch_;
  std::vector<int> new_clusters_;           ///< clusters that are not paired yet
  std::vector<std::int32_t> unused_lists_;  ///< unused indices in Neighbourhood::lists
  bool is_listed_ = false, must_pair_ = false;
  std::int64_t listed_ = 0, rebuilds_ = 0;
};

}  // namespace pliant
