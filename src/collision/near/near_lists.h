// Keeps near lists up to date: which pairs of primitives are near one another.
//
// A list is made where it is used, when the odometer of its two clusters has used up its margin. Where clearance or the clusters' boxes
// show that nothing can be near, the list stays empty and no primitive is looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/box_search.h"
#include "collision/near/clearance_search.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

class NearLists {
 public:
  NearLists(const PairModel& model, const PairKernels& kernels);
  NearLists(const NearLists&) = delete;
  NearLists& operator=(const NearLists&) = delete;

  /// Forces a broad-phase rebuild: positions were changed by something other than the measured steps.
  void forget() { is_listed_ = false; }
  /// Measures the substep's motion. Returns whether every position at its end is finite and below 1e14 m; if not, nothing else may be
  /// asked for in this substep.
  bool measure(Executor& executor, const PairParticles& particles);
  /// After measure(): sees to it that all pairs that can matter in this substep are listed.
  void update(Executor& executor, const PairParticles& particles);
  /// After the substep: the motion that was measured last has been made.
  void advance();

  Neighbourhood& neighbourhood() { return near_; }
  const Neighbourhood& neighbourhood() const { return near_; }
  std::int64_t candidates() const { return candidates_; }
  /// The number of broad-phase rebuilds.
  std::int64_t rebuilds() const { return rebuilds_; }

 private:
  /// What one thread works with.
  struct Scratch {
    std::vector<std::int32_t> stale;
    BoxSearch::Scratch search;
  };

  NearLists(const PairModel& model, const PairKernels& kernels, std::vector<Clearance::Line> joined);
  float skin() const;
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
  bool is_listed_ = false;
  std::int64_t candidates_ = 0, rebuilds_ = 0;
};

}  // namespace pliant
