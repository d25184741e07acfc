#include "collision/filter/step_filter.h"

#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace pliant {

namespace {

/// In these first rounds a vertex keeps the share of its step that a pair permits; in later ones it stays at its start.
constexpr int rounds_of_shares = 3;
/// After these rounds, or where rounding in a frame is too coarse, frames stand still, so that positions which stay are
/// not rounded.
constexpr int rounds_of_frames = 32;
constexpr int passes_of_fit = 3;

bool moves_in(const Vec3f& frame, const Record& d) { return d.x != frame.x || d.y != frame.y || d.z != frame.z; }

}  // namespace

/// The inputs that all tasks of a round share.
struct StepFilter::Round {
  Neighbourhood& near;
  const PairParticles& particles;
  const FunctionRef<bool(const PairStencil&)>& is_exempt;
  const FilterFrames& frames;

  void plan_list(const NearList& list, Scratch& scratch) const;
  void plan_group(const StaticGroup& group, Scratch& scratch) const;
  void plan_block(const ClusterSides& sides, const PairStencils& stencils, int pairs, float margin,
                  Scratch& scratch) const;
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
  // Rejects the pair by its own distance and motion, so that the result does not depend on how tight the stored bound
  // was.
  if (static_cast<float>(at.distance) * sum_slack - lanes.paths.falls[lane] > margin) return;
  if (!frames.share_one(pair)) {
    scratch.between.push_back(pair);
    return;
  }
  SeparatingSlab slab;
  std::array<float, 4> shares{1, 1, 1, 1};
  const Separation found = plan_separation(pair, at, particles.positions, particles.displacements,
                                           frames.of(pair.vertex[0]), double(margin), slab, shares);
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
                       FunctionRef<const FreeBodies&()> find_free, FunctionRef<bool(const PairStencil&)> is_exempt) {
  begin();
  for (int round = 0;; ++round) {
    if (round == rounds_of_frames) frames_.stop();
    if (!lists.measure(executor, particles)) return false;
    lists.update(executor, particles);
    const auto plan_once = [&] { plan(executor, lists.neighbourhood(), particles, is_exempt); };
    plan_once();
    if (round == 0 && has_planned()) {
      frames_.know(find_free());
      if (frames_.any()) fit_frames(particles, plan_once);
    }
    note_slabs();
    const bool has_truncated = truncate(particles, round >= rounds_of_shares);
    const bool are_united = unite_frames();
    if (!has_truncated && !are_united && !are_stuck_) break;
    if (are_stuck_) frames_.stop();
  }
  count();
  std::erase_if(before_, [&](const VertexDisplacement& of) { return !frames_.is_free(of.first); });
  std::erase_if(slabs_, [&](const SeparatingSlab& slab) { return !frames_.is_free(slab.pair.vertex[0]); });
  if (!before_.empty())
    keep_momentum(before_, slabs_, model_.shared->vertex_body, particles.positions, particles.displacements,
                  without_velocity_);
  return true;
}

void StepFilter::begin() {
  truncated_in_.clear();
  before_.clear();
  slabs_.clear();
  without_velocity_.clear();
  lost_momentum_ = {};
  frames_.begin();
}

bool StepFilter::has_planned() const {
  return std::any_of(scratch_.begin(), scratch_.end(),
                     [](const Scratch& scratch) { return !scratch.shares.empty() || !scratch.between.empty(); });
}

/// What is cut depends on the frame, and the frame on what is cut; a few passes find both well enough.
void StepFilter::fit_frames(const PairParticles& particles, FunctionRef<void()> plan) {
  std::vector<float>& shares = model_.shared->permitted_shares;
  std::vector<FilterFrames::Cut> cuts(model_.shared->rules.bodies());
  for (int pass = 0; pass < passes_of_fit; ++pass) {
    plan();
    unite_frames();
    touched_.clear();
    for (const Scratch& scratch : scratch_)
      for (const auto& [v, share] : scratch.shares) {
        if (!frames_.is_free(v)) continue;
        if (shares[v] == 1) touched_.push_back(v);
        shares[v] = min(shares[v], share);
      }
    std::sort(touched_.begin(), touched_.end());  // of each body; sums are by bodies, whose blocks may be in any order
    std::fill(cuts.begin(), cuts.end(), FilterFrames::Cut{});
    for (const std::int32_t v : touched_) {
      const Record &d = particles.displacements[v], &x = particles.positions[v];
      const double weight = (1 - double(shares[v])) / double(x.w);
      FilterFrames::Cut& cut = cuts[model_.shared->vertex_body[v]];
      cut.moved += Vec3d{double(d.x), double(d.y), double(d.z)} * weight;
      cut.weight += weight;
      cut.extent = max(cut.extent, max(max(std::abs(x.x), std::abs(x.y)), std::abs(x.z)));
      shares[v] = 1;
    }
    frames_.move(cuts);
  }
  plan();
}

void StepFilter::plan(Executor& executor, Neighbourhood& near, const PairParticles& particles,
                      const FunctionRef<bool(const PairStencil&)>& is_exempt) {
  scratch_.resize(near.tasks.size());
  const Round round{near, particles, is_exempt, frames_};
  executor.parallel_for("filter moves", static_cast<int>(near.tasks.size()), [&](int number) {
    const NearTask& task = near.tasks[number];
    Scratch& scratch = scratch_[number];
    scratch.slabs.clear();
    scratch.shares.clear();
    scratch.unresolvable.clear();
    scratch.between.clear();
    for (int g = task.first_group; g < task.last_group; ++g) round.plan_group(near.static_pairs.groups[g], scratch);
    for (int i = task.first; i < task.last; ++i) round.plan_list(near.lists[near.order[i]], scratch);
  });
}

/// Truncates each vertex's step to the smallest share that its pairs permit, or to zero if `stops`. Vertices that
/// rounding would still put beyond a plane then stay at their start. Returns true if any step was truncated.
bool StepFilter::truncate(const PairParticles& particles, bool stops) {
  std::vector<float>& shares = model_.shared->permitted_shares;
  touched_.clear();
  are_stuck_ = false;
  const auto allow = [&](std::int32_t v, float share) {
    if (!moves_in(frames_.of(v), particles.displacements[v])) {
      are_stuck_ = are_stuck_ || frames_.of(v) != Vec3f{};
      return;
    }
    if (shares[v] == 1) touched_.push_back(v);
    shares[v] = min(shares[v], stops ? 0 : share);
  };
  for (const Scratch& scratch : scratch_)
    for (const auto& [vertex, share] : scratch.shares) allow(vertex, share);
  hold_rounded(particles, allow);
  std::sort(touched_.begin(), touched_.end());  // sums do not depend on the order of lists
  for (const std::int32_t v : touched_) {
    Record& d = particles.displacements[v];
    const Record before = d;
    d = pliant::truncated(d, frames_.of(v), shares[v]);
    if (frames_.is_free(v)) {
      before_.emplace_back(v, Vec3f{before.x, before.y, before.z});
    } else {
      const double rate = 1 / (double(particles.positions[v].w) * double(particles.h));
      lost_momentum_ +=
          Vec3d{double(before.x) - double(d.x), double(before.y) - double(d.y), double(before.z) - double(d.z)} * rate;
    }
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
          if (shares[v] == 0 || !ends_beyond(slab, i, particles.positions, particles.displacements, shares[v]))
            continue;
          allow(v, 0);
          again = shares[v] == 0 || again;
        }
  }
}

/// Unites the frames of bodies between which a pair needs one plane. Such pairs are tested again in the next round.
bool StepFilter::unite_frames() {
  std::vector<PairStencil> between;
  for (const Scratch& scratch : scratch_) between.insert(between.end(), scratch.between.begin(), scratch.between.end());
  return frames_.unite(between);
}

void StepFilter::note_slabs() {
  for (const Scratch& scratch : scratch_)
    for (const SeparatingSlab& slab : scratch.slabs)
      if (frames_.is_free(slab.pair.vertex[0])) slabs_.push_back(slab);
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
