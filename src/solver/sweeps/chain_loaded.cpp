#include "solver/sweeps/chain_loaded.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "solver/sweeps/chain_link.h"

namespace pliant {

namespace {

/// The square root of a particle's inverse mass tensor.
struct RootInertia {
  Vec3f axis{};
  float along = 0, across = 0;

  Vec3f operator()(const Vec3f& v) const { return v * across + axis * ((along - across) * dot(axis, v)); }
};

/// What back substitution needs of a link, and what it finds.
struct LoadedLink {
  Vec3f direction{};
  float change = 0;    ///< dlambda, after elimination as if no link followed
  float coupling = 0;  ///< factor by which this link's dlambda changes that of the previous one
  Vec3f move{};        ///< of the link's second particle [m]
  float tension = 0;   ///< of the first solve, times h^2 and over the length; 0 where pushed or not yet solved [kg]
};

/// What link k + 1 needs of link k, as ChainEnd.
struct LoadedEnd {
  Vec3f direction{};
  RootInertia root{};  ///< of the particle between the links
  float mobility = 0, added = 0, inverse_pivot = 0, change = 0;
};

class LoadedLane {
 public:
  LoadedLane(const Pool& pool, const Segment* links, int steps, int lane, const SweepArguments& a,
             const ChainLoads& loads, float* multipliers)
      : pool_(pool), links_(links), lane_(lane), a_(a), loads_(loads), multipliers_(multipliers) {
    while (steps_ < steps && lane < links[steps_].last_count) ++steps_;  // longer paths come first
  }

  /// Solves the path, without the bodies from which it would pull particles away.
  void solve(float softness, float* scratch) const {
    for (int k = 0; k < steps_; ++k) put(scratch, k, {});
    const float tied = mass_of_ties();
    if (tied > 0) softness *= mass_of_path() / (mass_of_path() + tied);
    for (int attempt = 0; attempt <= most_attempts; ++attempt) {
      eliminate_all(softness, scratch);
      const Vec3f first = substitute(scratch);
      if (!release(first, scratch, attempt == most_attempts)) return finish(first, softness, tied > 0, scratch);
    }
    eliminate_all(softness, scratch);
    finish(substitute(scratch), softness, tied > 0, scratch);
  }

 private:
  static constexpr int most_attempts = 3, most_rounds = 8;

  /// Applies the solution. A path that is tied to bodies is solved again with the inertia across that its tensions
  /// demand, until these grow no more: light particles that zigzag yield at first, and hide how hard the rope is
  /// pulled.
  void finish(const Vec3f& first, float softness, bool is_tied, float* scratch) const {
    Vec3f moved = first;
    for (int round = 0; is_tied && round < most_rounds && keep_tensions(scratch); ++round) {
      eliminate_all(softness, scratch);
      moved = substitute(scratch);
    }
    apply(moved, scratch);
  }

  float mass_of_path() const {
    float mass = 0;
    for (int k = -1; k < steps_; ++k) {
      const float w = a_.positions[k < 0 ? particle(0, 0) : particle(k, 1)].w;
      mass += w > 0 ? 1 / w : 0;
    }
    return mass;
  }

  /// What ties add to the masses of the path's particles, along the ties.
  float mass_of_ties() const {
    float mass = 0;
    for (int k = -1; k < steps_; ++k) {
      const int number = k < 0 ? particle(0, 0) : particle(k, 1);
      const std::int32_t load = loads_.of_particle[number];
      if (load < 0 || !is_tie(loads_.inertias[load]) || !(loads_.inertias[load].root_along > 0)) continue;
      const float root = loads_.inertias[load].root_along;
      mass += 1 / (root * root) - 1 / a_.positions[number].w;
    }
    return mass;
  }
  static bool is_tie(const LoadedInertia& load) { return load.farthest == infinity; }

  /// Keeps the greatest tensions of the solutions. True if they have grown and demand more inertia across of a
  /// particle.
  bool keep_tensions(float* scratch) const {
    bool any = false;
    float before = 0, old_before = 0;
    for (int k = 0; k < steps_; ++k) {
      LoadedLink link = get(scratch, k);
      const float length = pool_.row(0, links_[k].first_batch)[lane_], old = link.tension;
      link.tension = max(old, -link.change / max(length, smallest_denominator));
      put(scratch, k, link);
      const float own = k > 0 && a_.positions[particle(k, 0)].w > 0 ? 1 / a_.positions[particle(k, 0)].w : infinity;
      const float across = inertia_across(before, link.tension);
      any = any || (across > own && across > grown * inertia_across(old_before, old));
      before = link.tension;
      old_before = old;
    }
    return any;
  }
  static constexpr float least_root = 1e-3f;  ///< a million times the inertia is the most that pivots of floats resolve
  static constexpr float grown = 1.1f, infinity = std::numeric_limits<float>::infinity();
  static float inertia_across(float tension, float next) { return 2 * (tension + next); }

  void eliminate_all(float softness, float* scratch) const {
    LoadedEnd end;
    end.root = root_of(particle(0, 0));
    for (int k = 0; k < steps_; ++k) {
      const float tension = get(scratch, k).tension;
      LoadedLink link = eliminate(k, softness, root_between(k, scratch), end);
      link.tension = tension;
      put(scratch, k, link);
    }
  }

  /// Returns the displacement of the path's first particle; puts those of the others into the links.
  Vec3f substitute(float* scratch) const {
    Vec3f pull{};
    float change = 0, coupling = 0;
    for (int k = steps_ - 1; k >= 0; --k) {
      LoadedLink link = get(scratch, k);
      link.change += coupling * change;
      change = link.change;
      coupling = link.coupling;
      const Vec3f own = link.direction * change;
      const RootInertia root = root_between(k, scratch);
      link.move = root(root(own - pull));
      pull = own;
      put(scratch, k, link);
    }
    const RootInertia root = root_of(particle(0, 0));
    return root(root(-pull));
  }

  /// Releases particles that would leave their bodies, or all. Returns true if there are any.
  bool release(const Vec3f& first, const float* scratch, bool all) const {
    bool any = release(particle(0, 0), first, all);
    for (int k = 0; k < steps_; ++k) any = release(particle(k, 1), get(scratch, k).move, all && any) || any;
    return any;
  }
  bool release(int particle, const Vec3f& move, bool always) const {
    const std::int32_t load = loads_.of_particle[particle];
    if (load < 0 || loads_.is_released[load] != 0) return false;
    if (!always && !(dot(loads_.inertias[load].axis, move) > loads_.inertias[load].farthest)) return false;
    loads_.is_released[load] = 1;
    return true;
  }

  void apply(const Vec3f& first, const float* scratch) const {
    move(particle(0, 0), first);
    for (int k = 0; k < steps_; ++k) {
      const LoadedLink link = get(scratch, k);
      move(particle(k, 1), link.move);
      if (multipliers_ != nullptr) *multiplier(k) = a_.first_pass ? link.change : *multiplier(k) + link.change;
    }
  }

  static LoadedLink get(const float* scratch, int k) {
    LoadedLink link;
    std::memcpy(static_cast<void*>(&link), scratch + k * floats_per_link, sizeof link);
    return link;
  }
  static void put(float* scratch, int k, const LoadedLink& link) {
    std::memcpy(scratch + k * floats_per_link, &link, sizeof link);
  }
  static constexpr int floats_per_link = sizeof(LoadedLink) / sizeof(float);
  static_assert(floats_per_link * static_cast<int>(sizeof(float)) == sizeof(LoadedLink));

  /// The inertia of link k's second particle.
  ///
  /// A taut string of light particles has transverse waves that a substep cannot follow: forces along directions of the
  /// prediction are stable up to (omega h)^2 = 4/3 (x' = x + h v', v' = v - h omega^2 (x + h v)). With tensions T and
  /// lengths L of both links, omega^2 is at most 2 (T / L + T' / L') / m, so an inertia of 2 h^2 (T / L + T' / L')
  /// across them keeps it to 1 / h^2.
  RootInertia root_between(int k, const float* scratch) const {
    const int number = particle(k, 1);
    RootInertia root = root_of(number);
    if (k + 1 == steps_) return root;
    const LoadedLink link = get(scratch, k), next = get(scratch, k + 1);
    const float across = inertia_across(link.tension, next.tension);
    if (!(across * a_.positions[number].w > 1)) return root;
    if (loads_.of_particle[number] >= 0) {  // its axis is that of the tie or contact
      root.across = min(root.across, max(1 / std::sqrt(across), least_root * root.across));
      return root;
    }
    const Vec3f along = way(k) + way(k + 1);
    const float size = length(along);
    if (!(size > smallest_denominator)) return root;
    root.axis = along * (1 / size);
    root.across = max(1 / std::sqrt(across), least_root * std::sqrt(a_.positions[number].w));
    return root;
  }

  /// From the first particle of link k to the second, as predicted [m].
  Vec3f way(int k) const {
    const int from = particle(k, 0), to = particle(k, 1);
    const Record &p = a_.positions[from], &q = a_.positions[to];
    const Record &d = a_.displacements[from], &e = a_.displacements[to];
    return {(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
  }

  LoadedLink eliminate(int k, float softness, const RootInertia& root, LoadedEnd& end) const {
    const Vec3f across = way(k);
    const float length = std::sqrt(dot(across, across));
    const Vec3f n = across * (1 / max(length, smallest_denominator));
    const std::int64_t batch = links_[k].first_batch;
    const float compliance = min(pool_.row(1, batch)[lane_] * a_.inverse_h2, largest_compliance);
    const float before = multipliers_ != nullptr && !a_.first_pass ? *multiplier(k) : 0.f;
    const Vec3f u = end.root(end.direction), v = end.root(n);
    float mobility = length_squared(v), coupled = 0, coupling = 0;
    if (k > 0) {
      mobility = (mobility * (end.mobility + end.added) + length_squared(cross(u, v))) * end.inverse_pivot;
      coupled = dot(u, v);
      coupling = coupled * end.inverse_pivot;
    }
    const float added = softness + compliance;
    const float inverse_pivot = 1 / max(mobility + length_squared(root(n)) + added, smallest_denominator);
    const float missing = length > smallest_denominator ? pool_.row(0, batch)[lane_] - length : 0;
    const float change = ((missing - compliance * before) + coupled * end.change) * inverse_pivot;
    end = {n, root, mobility, added, inverse_pivot, change};
    return {n, change, coupling, {}};
  }

  int particle(int k, int slot) const {
    return pool_.indices[static_cast<std::size_t>(links_[k].index_offset) +
                         static_cast<std::size_t>(slot * batch_width + lane_)];
  }
  float* multiplier(int k) const {
    return multipliers_ + static_cast<std::int64_t>(links_[k].first_batch) * batch_width + lane_;
  }
  RootInertia root_of(int particle) const {
    const std::int32_t load = loads_.of_particle[particle];
    if (load < 0 || loads_.is_released[load] != 0) {
      const float root = std::sqrt(a_.positions[particle].w);
      return {{}, root, root};
    }
    const LoadedInertia& of = loads_.inertias[load];
    return {of.axis, of.root_along, of.root_across};
  }
  void move(int particle, const Vec3f& by) const {
    Record& d = a_.displacements[particle];
    d = {d.x + by.x, d.y + by.y, d.z + by.z, 0};
  }

  const Pool& pool_;
  const Segment* links_;
  int lane_, steps_ = 0;
  const SweepArguments& a_;
  const ChainLoads& loads_;
  float* multipliers_;
};

}  // namespace

void solve_loaded_chains(const ChainTask& task, std::uint32_t lanes, const SweepArguments& a, const ChainLoads& loads,
                         float* scratch) {
  for (int i = 0; i < task.links->last_count; ++i)
    if ((lanes >> i & 1u) != 0)
      LoadedLane(task.pool, task.links, task.steps, i, a, loads, task.multipliers).solve(task.softness[i], scratch);
}

KeptLanes::KeptLanes(const ChainTask& task, std::uint32_t lanes, const SweepArguments& a) : task_(task), arguments_(a) {
  const auto paths = static_cast<std::size_t>(__builtin_popcount(lanes)), steps = static_cast<std::size_t>(task.steps);
  displacements_.reserve(paths * (steps + 1));
  if (task.multipliers != nullptr) multipliers_.reserve(paths * steps);
  for (int k = 0; k < task.steps; ++k) {
    const Segment& link = task.links[k];
    const std::int32_t* const points = task.pool.indices.data() + link.index_offset;
    for (int lane = 0; lane < link.last_count; ++lane) {
      if ((lanes >> lane & 1u) == 0) continue;
      const int to = points[batch_width + lane];
      if (k == 0) displacements_.emplace_back(points[lane], a.displacements[points[lane]]);
      displacements_.emplace_back(to, a.displacements[to]);
      const std::int64_t row = static_cast<std::int64_t>(link.first_batch) * batch_width + lane;
      if (task.multipliers != nullptr) multipliers_.emplace_back(row, task.multipliers[row]);
    }
  }
}

void KeptLanes::restore() const {
  for (const auto& [particle, displacement] : displacements_) arguments_.displacements[particle] = displacement;
  for (const auto& [row, value] : multipliers_) task_.multipliers[row] = value;
}

}  // namespace pliant
