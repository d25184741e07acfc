// The filter over all pairs: each vertex takes the smallest step that any of its pairs permits (plane_filter.h).
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "collision/filter/filter_frames.h"
#include "collision/filter/pair_impulses.h"
#include "collision/filter/plane_filter.h"
#include "collision/near/near_lists.h"

namespace pliant {

/// The unresolvable pairs between two bodies: pairs of primitives that no step limit keeps apart.
struct UnresolvablePairs {
  PairStencil first;
  std::int64_t count = 0;
};

class StepFilter {
 public:
  explicit StepFilter(const PairModel& model) : model_(model), frames_(model) { fit_to_model(); }

  /// Resizes the permitted shares of steps to the model; call it after bodies were added or removed.
  void fit_to_model();
  /// Resets the counts; call it at a frame's start.
  void forget_counts();
  /// Truncates displacements so that no pair crosses, unless `is_exempt` holds for it. Measures the motion again after
  /// each round. Returns true if all positions are bounded (NearLists::measure); else displacements may be unchanged.
  /// Of free bodies it keeps the momentum: without_velocity().
  bool apply(Executor& executor, NearLists& lists, const PairParticles& particles,
             FunctionRef<const FreeBodies&()> find_free, FunctionRef<bool(const PairStencil&)> is_exempt);

  const FilterFrames& frames() const { return frames_; }
  /// What is not to become velocity of the displacements after the last apply.
  const std::vector<VertexDisplacement>& without_velocity() const { return without_velocity_; }

  /// The number of truncated steps in this frame: vertices with a truncated step, summed over substeps.
  std::int64_t truncated() const { return truncated_; }
  /// The momentum that the last apply took from what is not free [kg m/s].
  const Vec3d& lost_momentum() const { return lost_momentum_; }
  std::int64_t unresolvable_count() const { return unresolvable_count_; }
  /// Unresolvable pairs of this frame by their two bodies, the lower index first.
  const std::map<std::pair<int, int>, UnresolvablePairs>& unresolvable() const { return unresolvable_; }

 private:
  /// Scratch memory of one thread.
  struct Scratch {
    std::vector<SeparatingSlab> slabs;
    std::vector<std::pair<std::int32_t, float>> shares;
    std::vector<PairStencil> unresolvable;
    std::vector<PairStencil> between;  ///< pairs whose bodies have different frames
  };
  struct Round;

  void plan(Executor& executor, Neighbourhood& near, const PairParticles& particles,
            const FunctionRef<bool(const PairStencil&)>& is_exempt);
  bool truncate(const PairParticles& particles, bool stops);
  template <class Allow>
  void hold_rounded(const PairParticles& particles, Allow allow);
  void begin();
  bool has_planned() const;
  void fit_frames(const PairParticles& particles, FunctionRef<void()> plan);
  bool unite_frames();
  void note_slabs();
  void count();

  const PairModel& model_;
  FilterFrames frames_;
  std::vector<VertexDisplacement> before_;  ///< of free vertices whose steps were truncated in this substep
  std::vector<SeparatingSlab> slabs_;       ///< of free pairs in this substep
  std::vector<VertexDisplacement> without_velocity_;
  std::vector<Scratch> scratch_;
  std::vector<std::int32_t> touched_, truncated_in_;  ///< vertices truncated in the current round; in this substep
  bool are_stuck_ = false;  ///< true: vertices end beyond a plane because the displacement of their frame rounds them
  Vec3d lost_momentum_{};
  std::int64_t truncated_ = 0, unresolvable_count_ = 0;
  std::map<std::pair<int, int>, UnresolvablePairs> unresolvable_;
};

}  // namespace pliant
