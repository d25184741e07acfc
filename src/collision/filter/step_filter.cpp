#include "collision/filter/step_filter.h"

#include <algorithm>

namespace pliant {

namespace {

/// In these first rounds a vertex keeps the share of its step that a pair permits; in later ones it stays at its start.
constexpr int rounds_of_shares = 3;

bool moves_at_all(const Record& d) { return d.x != 0 || d.y != 0 || d.z != 0; }

}  // namespace

/// The inputs that all tasks of a round share.
struct StepFilter::Round {
  Neighbourhood& near;
  const PairParticles& particles;
  const FunctionRef<bool(const PairStencil&)>& is_exempt;

  void plan_list(const NearList& list, Scratch& scratch) const;
  void plan_group(const StaticGroup& group, Scratch& scratch) const;
  void plan_block(const ClusterSides& sides, const PairStencils& stencils, int pairs, float margin, Scratch& scratch) const;
  void plan_pair(const ClusterSides& sides, const PairLanes& lanes, int lane, float margin, Scratch& scratch) const;
};

void StepFilter::Round::plan_list(const NearList& list, Scratch& scratch) const {
  const Odometer& odometer = near.odometer(list);
  const float margin = filter_margin(near, list);
  if (list.least.after(odometer) > margin || is_too_far(near, list)) return;
  const float spent = list.least.spent(odometer) + odometer.next;
  for (std::size_t b = 0; b < list.blocks.size(); ++b)
    if (!(list.value[b] - spent > margin)) plan_block(list, list.blocks[b].stencils, list.pairs_in(b), margin, scratch);
}

void StepFilter::Round::plan_group(const StaticGroup& group, Scratch& scratch) const {
  const Odometer& odometer = near.odometer(group);
  const float margin = filter_margin(near, group);
  if (group.least.after(odometer) > margin || is_too_far(near, group)) return;
  const float spent = group.least.spent(odometer) + odometer.next;
  for (std::size_t b = 0; b < group.blocks.size(); ++b)
    if (!(group.value[b] - spent > margin)) plan_block(group, group.blocks[b], group.pairs_in(b), margin, scratch);
}

void StepFilter::Round::plan_block(const ClusterSides& sides, const PairStencils& stencils, int pairs, float margin,
                                   Scratch& scratch) const {
  alignas(64) float at_least[16];
  near.kernels.lower_bounds(stencils, sides.of_vertices ? 1 : 2, particles.positions, at_least);
  const float within = margin + near.odometer(sides).next;
  if (std::none_of(at_least, at_least + pairs, [&](float bound) { return bound <= within; })) return;
  PairLanes lanes;
  lanes.stencils = stencils;
  find_paths(near, sides, particles, lanes);
  for (int lane = 0; lane < pairs; ++lane)
    if (at_least[lane] <= within) plan_pair(sides, lanes, lane, margin, scratch);
}

void StepFilter::Round::plan_pair(const ClusterSides& sides, const PairLanes& lanes, int lane, float margin,
                                  Scratch& scratch) const {
  if (lanes.paths.apart[lane] > margin) return;
  const PairStencil pair = lanes.pair(lane, sides.of_vertices);
  if (is_exempt(pair)) return;
  const PairDistance at = pair_distance(pair, particles.positions);
  // Rejects the pair by its own distance and motion, so that the result does not depend on how tight the stored bound was.
  if (static_cast<float>(at.distance) * sum_slack - lanes.paths.falls[lane] > margin) return;
  SeparatingSlab slab;
  std::array<float, 4> shares{1, 1, 1, 1};
  const Separation found =
      plan_separation(pair, at, particles.positions, particles.displacements, double(margin), slab, shares);
  if (found == Separation::free) return;
  if (found == Separation::unresolvable) scratch.unresolvable.push_back(pair);
  if (found == Separation::planned) scratch.slabs.push_back(slab);
  for (int i = 0; i < 4; ++i)
    if (shares[i] < 1) scratch.shares.emplace_back(pair.vertex[i], shares[i]);
}

void StepFilter::fit_to_model() {
  std::vector<float>& shares = model_.shared->permitted_shares;
  if (shares.size() < model_.shared->rest.size()) shares.resize(model_.shared->rest.size(), 1.f);
}

void StepFilter::forget_counts() {
  truncated_ = unresolvable_count_ = 0;
  unresolvable_.clear();
}

/// Pairs are rejected by their relative motion, which grows when only one side is truncated. So the pairs are tested
/// again with the truncated steps, until no step changes.
bool StepFilter::apply(Executor& executor, NearLists& lists, const PairParticles& particles,
                       FunctionRef<bool(const PairStencil&)> is_exempt) {
  truncated_in_.clear();
  for (int round = 0;; ++round) {
    if (!lists.measure(executor, particles)) return false;
    lists.update(executor, particles);
    plan(executor, lists.neighbourhood(), particles, is_exempt);
    if (!truncate(particles, round >= rounds_of_shares)) break;
  }
  count();
  return true;
}

void StepFilter::plan(Executor& executor, Neighbourhood& near, const PairParticles& particles,
                      const FunctionRef<bool(const PairStencil&)>& is_exempt) {
  scratch_.resize(near.tasks.size());
  const Round round{near, particles, is_exempt};
  executor.parallel_for("filter moves", static_cast<int>(near.tasks.size()), [&](int number) {
    const NearTask& task = near.tasks[number];
    Scratch& scratch = scratch_[number];
    scratch.slabs.clear();
    scratch.shares.clear();
    scratch.unresolvable.clear();
    for (int g = task.first_group; g < task.last_group; ++g) round.plan_group(near.static_pairs.groups[g], scratch);
    for (int i = task.first; i < task.last; ++i) round.plan_list(near.lists[near.order[i]], scratch);
  });
}

/// Truncates each vertex's step to the smallest share that its pairs permit, or to zero if `stops`. Vertices that
/// rounding would still put beyond a plane then stay at their start. Returns true if any step was truncated.
bool StepFilter::truncate(const PairParticles& particles, bool stops) {
  std::vector<float>& shares = model_.shared->permitted_shares;
  touched_.clear();
  const auto allow = [&](std::int32_t v, float share) {
    if (!moves_at_all(particles.displacements[v])) return;
    if (shares[v] == 1) touched_.push_back(v);
    shares[v] = min(shares[v], stops ? 0 : share);
  };
  for (const Scratch& scratch : scratch_)
    for (const auto& [vertex, share] : scratch.shares) allow(vertex, share);
  hold_rounded(particles, allow);
  for (const std::int32_t v : touched_) {
    Record& d = particles.displacements[v];
    d = {d.x * shares[v], d.y * shares[v], d.z * shares[v], 0};
    shares[v] = 1;
  }
  truncated_in_.insert(truncated_in_.end(), touched_.begin(), touched_.end());
  return !touched_.empty();
}

template <class Allow>
void StepFilter::hold_rounded(const PairParticles& particles, Allow allow) {
  const std::vector<float>& shares = model_.shared->permitted_shares;
  for (bool again = true; again;) {
    again = false;
    for (const Scratch& scratch : scratch_)
      for (const SeparatingSlab& slab : scratch.slabs)
        for (int i = 0; i < 4; ++i) {
          const std::int32_t v = slab.pair.vertex[i];
          if (shares[v] == 0 || !ends_beyond(slab, i, particles.positions, particles.displacements, shares[v])) continue;
          allow(v, 0);
          again = shares[v] == 0 || again;
        }
  }
}

void StepFilter::count() {
  for (const Scratch& scratch : scratch_)
    for (const PairStencil& pair : scratch.unresolvable) {
      const int a = model_.shared->vertex_body[pair.vertex[0]], b = model_.shared->vertex_body[pair.vertex[3]];
      UnresolvablePairs& between = unresolvable_[std::minmax(a, b)];
      if (between.count++ == 0 || pair.vertex < between.first.vertex) between.first = pair;
      ++unresolvable_count_;
    }
  std::sort(truncated_in_.begin(), truncated_in_.end());
  truncated_ += std::unique(truncated_in_.begin(), truncated_in_.end()) - truncated_in_.begin();
}

}  // namespace pliant
