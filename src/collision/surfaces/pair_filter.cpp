// The filter of PairSystem, and the tangles that it leaves alone.
#include <algorithm>

#include "collision/proxies/triangles_around.h"
#include "collision/surfaces/pair_bounds.h"

namespace pliant {

namespace {

/// Rounds in which moves are shortened by as much as they must; after them offenders stay where they are.
constexpr int rounds_of_shares = 3;

bool moves_at_all(const Record& d) { return d.x != 0 || d.y != 0 || d.z != 0; }

}  // namespace

void PairSystem::filter_bucket(Bucket& bucket, Task& task, const PairParticles& particles) {
  collect_near(bucket, task, least_of(bucket));
  PairStencils pairs;
  PairPaths paths;
  for (std::size_t i = 0; i < task.near.size(); i += 16) {
    const std::size_t count = std::min<std::size_t>(16, task.near.size() - i);
    for (std::size_t lane = 0; lane < 16; ++lane)
      put(pairs, lane, bucket.pairs[task.near[i + (lane < count ? lane : 0)]].vertex);
    find_paths(bucket, pairs, particles, paths);
    for (std::size_t lane = 0; lane < count; ++lane) {
      bucket.least_reach = min(bucket.least_reach, bucket.reach[task.near[i + lane]]);
      filter_pair(bucket, pairs, paths, static_cast<int>(lane), particles, task);
    }
  }
}

void PairSystem::filter_surroundings(Surroundings& of, Task& task, const PairParticles& particles) {
  const float gone = moved(of) + moves(of), least = least_of(of);
  if (of.least_reach - gone > least) return;
  PairPaths paths;
  for (int b = of.first_block; b < of.last_block; ++b) {
    if (block_reach_[b] - gone > least) continue;
    find_paths(of, blocks_[b], particles, paths);
    const int count = std::min(16, of.pairs - 16 * (b - of.first_block));
    for (int lane = 0; lane < count; ++lane) filter_pair(of, blocks_[b], paths, lane, particles, task);
  }
}

void PairSystem::filter_pair(const Between& clusters, const PairStencils& pairs, const PairPaths& paths, int lane,
                             const PairParticles& particles, Task& task) {
  const float least = least_of(clusters);
  if (paths.apart[lane] > least) return;
  const PairStencil four = stencil_at(pairs, lane, clusters.of_vertices);
  if (is_tangled(four)) return;
  const PairDistance at = pair_distance(four, particles.positions);
  // What an old bound could not dismiss and a new one does is left alone: bounds only save work.
  if (static_cast<float>(at.distance) * sum_slack - paths.falls[lane] > least) return;
  SeparatingSlab slab;
  std::array<float, 4> shares{1, 1, 1, 1};
  const Separation found =
      plan_separation(four, at, particles.positions, particles.displacements, double(least), slab, shares);
  if (found == Separation::free) return;
  if (found == Separation::hopeless) task.hopeless.push_back(four);
  if (found == Separation::planned) task.slabs.push_back(slab);
  for (int i = 0; i < 4; ++i)
    if (shares[i] < 1) task.shares.emplace_back(four.vertex[i], shares[i]);
}

/// The least of what the pairs allow, or nothing of it; then what rounding let through stays where it was, until nothing more
/// does. Whether any move was shortened.
bool PairSystem::shorten(const PairParticles& particles, bool stops) {
  touched_.clear();
  const auto allow = [&](std::int32_t v, float share) {
    if (!moves_at_all(particles.displacements[v])) return;
    if (share_[v] == 1) touched_.push_back(v);
    share_[v] = min(share_[v], stops ? 0 : share);
  };
  for (const Task& task : tasks_)
    for (const auto& [vertex, share] : task.shares) allow(vertex, share);
  hold_rounded(particles, allow);
  for (const std::int32_t v : touched_) {
    Record& d = particles.displacements[v];
    d = {d.x * share_[v], d.y * share_[v], d.z * share_[v], 0};
    share_[v] = 1;
  }
  shortened_.insert(shortened_.end(), touched_.begin(), touched_.end());
  return !touched_.empty();
}

template <class Allow>
void PairSystem::hold_rounded(const PairParticles& particles, Allow allow) {
  for (bool again = true; again;) {
    again = false;
    for (const Task& task : tasks_)
      for (const SeparatingSlab& slab : task.slabs)
        for (int i = 0; i < 4; ++i) {
          const std::int32_t v = slab.pair.vertex[i];
          if (share_[v] == 0 || !ends_beyond(slab, i, particles.positions, particles.displacements, share_[v])) continue;
          allow(v, 0);
          again = share_[v] == 0 || again;
        }
  }
}

/// Pairs are dismissed by how much they move against each other, which grows where one of them alone is shortened: what was
/// shortened is looked at again as it is then, until no more is.
void PairSystem::keep_apart(Executor& executor, const PairParticles& particles) {
  shortened_.clear();
  for (int round = 0;; ++round) {
    measure_moves(executor, particles);
    if (!is_bounded_) return;
    bring_up_to_date(executor, particles);
    executor.parallel_for("filter moves", static_cast<int>(tasks_.size()), [&](int number) {
      Task& task = tasks_[number];
      task.slabs.clear();
      task.shares.clear();
      task.hopeless.clear();
      for (int s = task.first_surroundings; s < task.last_surroundings; ++s)
        filter_surroundings(surroundings_[s], task, particles);
      for (int b = task.first; b < task.last; ++b) filter_bucket(buckets_[b], task, particles);
    });
    if (!shorten(particles, round >= rounds_of_shares)) break;
  }
  count_hopeless();
  std::sort(shortened_.begin(), shortened_.end());
  counts_.shortened += std::unique(shortened_.begin(), shortened_.end()) - shortened_.begin();
}

void PairSystem::count_hopeless() {
  for (const Task& task : tasks_) {
    for (const PairStencil& pair : task.hopeless) {
      const int a = model_.vertex_body[pair.vertex[0]], b = model_.vertex_body[pair.vertex[3]];
      HopelessPairs& between = hopeless_[std::minmax(a, b)];
      if (between.count++ == 0) between.first = pair;
      ++counts_.hopeless;
    }
  }
}

void PairSystem::filter(Executor& executor, const PairParticles& particles) {
  counts_.contacts = 0;
  for (const PairContact& contact : contacts_) counts_.contacts += contact.push > 0 ? 1 : 0;
  if (model_.filter) {
    keep_apart(executor, particles);
  } else {
    measure_moves(executor, particles);
  }
  if (is_bounded_) settle_moves();
}

// ---------------------------------------------------------------- tangles

void PairSystem::find_tangles(const Record* positions) {
  std::vector<Vec3f> places(model_.rest.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = {positions[i].x, positions[i].y, positions[i].z};
  tangles_.clear();
  for (const Intersection& found : intersections_.find(places)) {
    const int a = model_.vertex_body[found.a], b = model_.vertex_body[model_.elements.triangles[found.triangle][0]];
    if (model_.meets[static_cast<std::size_t>(a) * model_.bodies + b] != 0) tangles_.push_back(found);
  }
  counts_.tangled = static_cast<std::int64_t>(tangles_.size());
  exempt_tangled();
}

/// Exempts the pairs that a tangled edge and triangle are made of, as their stencils.
void PairSystem::exempt_tangled() {
  tangled_.clear();
  const IntLists around = tangles_.empty() ? IntLists{} : triangles_around(model_.elements);
  const auto exempt_corner = [&](int vertex, const Triangle& t) { tangled_.push_back({vertex, t[0], t[1], t[2], 1}); };
  for (const Intersection& tangle : tangles_) {
    const Triangle& t = model_.elements.triangles[tangle.triangle];
    exempt_corner(tangle.a, t);
    exempt_corner(tangle.b, t);
    const std::array<int, 2> crossing{tangle.a, tangle.b};
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 2> side{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
      const auto &e = std::min(crossing, side), &f = std::max(crossing, side);
      tangled_.push_back({e[0], e[1], f[0], f[1], 2});
    }
    // The triangle's corners against the triangles of the edge.
    for (const int* other = around.begin(tangle.a); other != around.end(tangle.a); ++other) {
      const Triangle& o = model_.elements.triangles[*other];
      if (o[0] != tangle.b && o[1] != tangle.b && o[2] != tangle.b) continue;
      for (const int corner : t) exempt_corner(corner, o);
    }
  }
  std::sort(tangled_.begin(), tangled_.end());
}

void PairSystem::begin_frame(const Record* positions, bool anew) {
  const std::int64_t candidates = counts_.candidates, tangled = counts_.tangled, hopeless = counts_.hopeless;
  const bool untangles = untangler_ && untangler_->is_busy();
  counts_ = {};
  hopeless_.clear();
  counts_.candidates = candidates;
  counts_.tangled = tangled;
  // Clean pairs stay clean, unless nothing kept them: what has crossed is then exempt, as it would be in a state put back.
  const bool kept_apart = model_.filter && hopeless == 0;
  if (!anew && tangles_.empty() && kept_apart && !untangles) return;
  find_tangles(positions);
  if (untangler_) {
    untangler_->begin_frame(positions, tangles_);
    counts_.inside = untangler_->inside();
  }
  if (anew) listed_ = false;
}

}  // namespace pliant
