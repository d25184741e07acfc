// The filter over all pairs: each vertex takes the smallest step that any of its pairs permits (plane_filter.h).
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "collision/filter/plane_filter.h"
#include "collision/near/near_lists.h"

namespace pliant {

/// Pairs between two bodies that no step limit keeps apart.
struct UnresolvablePairs {
  PairStencil first;
  std::int64_t count = 0;
};

class StepFilter {
 public:
  explicit StepFilter(const PairModel& model) : model_(model), share_(model.rest.size(), 1.f) {}

  /// At a frame's start.
  void forget_counts();
  /// Truncates displacements so that no pair crosses, but those for which `is_exempt` holds. The substep's motion is measured anew
  /// after each round. Returns whether all positions are bounded (NearLists::measure); if not, displacements may be left as they are.
  bool apply(Executor& executor, NearLists& lists, const PairParticles& particles,
             FunctionRef<bool(const PairStencil&)> is_exempt);

  /// Vertices whose step was truncated, once a substep each; pairs that could not be kept apart: of this frame.
  std::int64_t truncated() const { return truncated_; }
  std::int64_t unresolvable_count() const { return unresolvable_count_; }
  /// By their bodies, the lower one first.
  const std::map<std::pair<int, int>, UnresolvablePairs>& unresolvable() const { return unresolvable_; }

 private:
  /// What one thread finds.
  struct Scratch {
    std::vector<std::int32_t> near;
    std::vector<SeparatingSlab> slabs;
    std::vector<std::pair<std::int32_t, float>> shares;
    std::vector<PairStencil> unresolvable;
  };
  struct Round;

  void plan(Executor& executor, Neighbourhood& near, const PairParticles& particles,
            const FunctionRef<bool(const PairStencil&)>& is_exempt);
  bool truncate(const PairParticles& particles, bool stops);
  template <class Allow>
  void hold_rounded(const PairParticles& particles, Allow allow);
  void count();

  const PairModel& model_;
  std::vector<Scratch> scratch_;
  std::vector<float> share_;                          ///< of each vertex' step, in a round
  std::vector<std::int32_t> touched_, truncated_in_;  ///< vertices, in a round and in a substep
  std::int64_t truncated_ = 0, unresolvable_count_ = 0;
  std::map<std::pair<int, int>, UnresolvablePairs> unresolvable_;
};

}  // namespace pliant
