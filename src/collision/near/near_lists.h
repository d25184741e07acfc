// Keeps near lists (neighbour lists of primitives) up to date.
//
// A list is rebuilt on use, when the odometer of its two clusters has exhausted its skin. If the clearance or the
// cluster boxes prove that nothing is near, the list stays empty and no primitive is tested.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/box_search.h"
#include "collision/near/clearance_search.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

/// All near lists. It has over thirty members, because near_lists.cpp and near_changes.cpp (bodies added and removed)
/// divide the work on the same lists into short steps.
class NearLists {
 public:
  NearLists(const PairModel& model, const PairKernels& kernels);
  NearLists(const NearLists&) = delete;
  NearLists& operator=(const NearLists&) = delete;

  /// Removes and adds bodies, given by their clusters. Lists and bounds of all other bodies are kept.
  void change(const PairChanges& changes);

  /// Requests a broad-phase rebuild; needed after positions changed by anything but the measured motion.
  void forget() { is_listed_ = false; }
  /// Measures the motion of this substep. Returns true if all end positions are finite and below 1e14 m. If not, no
  /// other function may be called in this substep.
  bool measure(Executor& executor, const PairParticles& particles);
  /// Updates the lists so that they contain all pairs that can come near in this substep; call it after measure().
  void update(Executor& executor, const PairParticles& particles);
  /// Adds the measured motion to the odometers; call it after the substep.
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
  void carry_groups(const std::vector<ClusterPair>& old, const std::vector<int>& pairs);
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
  std::vector<int> new_clusters_;           ///< clusters that are in no cluster pair yet
  std::vector<std::int32_t> unused_lists_;  ///< indices of unused entries of Neighbourhood::lists
  bool is_listed_ = false, must_pair_ = false;
  std::int64_t listed_ = 0, rebuilds_ = 0;
};

}  // namespace pliant
