// The lists of PairSystem: candidates, and until when they hold.
#include <algorithm>
#include <limits>

#include "collision/pair_bounds.h"

namespace pliant {

namespace {

constexpr int pairs_in_a_task = 4096;
/// What the filter keeps, as a share of the thickness; and at least so many roundings of the positions.
constexpr float least_share = 0.05f, least_roundings = 32;
/// Places as seen by one who drifts along are rounded this often, at most.
constexpr float place_roundings = 16;

}  // namespace

/// Measures the extent. Where a value is not finite, the end of the substep says so; until then nothing is looked for.
bool PairSystem::is_finite(const PairParticles& particles) {
  extent_ = 0;
  for (const int v : model_.elements.vertices) {
    const Vec3f p = end_of(particles, static_cast<std::size_t>(v));
    if (!(abs(p.x) < 1e14f && abs(p.y) < 1e14f && abs(p.z) < 1e14f)) return false;
    extent_ = max(extent_, largest(end_of(particles, static_cast<std::size_t>(v), 0)));
  }
  return true;
}

PairStencil PairSystem::stencil(const Bucket& bucket, std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  if (bucket.vertices) {
    const Triangle& t = model_.elements.triangles[p.b];
    return {{p.a, t[0], t[1], t[2]}, 1};
  }
  const auto &e = model_.elements.edges[p.a], &f = model_.elements.edges[p.b];
  return {{e[0], e[1], f[0], f[1]}, 2};
}

const PairMaterial& PairSystem::material(const Bucket& bucket) const {
  const int a = model_.cluster_body[bucket.first_cluster], b = model_.cluster_body[bucket.second_cluster];
  return model_.materials[static_cast<std::size_t>(a) * model_.bodies + b];
}

float PairSystem::least_of(float thickness) const {
  return max(least_share * thickness, least_roundings * rounding * extent_);
}

/// How far vertices may leave their boxes while lists hold all pairs whose paths come within `distance`.
float PairSystem::margin_beyond(float distance) const {
  return 0.5f * (model_.radius - distance) - place_roundings * rounding * extent_;
}

/// Whether the boxes of both sides' paths come within `distance`, as seen by one who drifts along. Lists hold all pairs of which
/// this is true, whenever they were made, so that with it what is done about a pair does not depend on them.
bool PairSystem::paths_within(const PairStencil& pair, const PairParticles& particles, float distance) const {
  Vec3f low[2], high[2];
  for (int i = 0; i < 4; ++i) {
    const auto v = static_cast<std::size_t>(pair.vertex[i]);
    const Vec3f from = end_of(particles, v, 0), to = end_of(particles, v) - mean_;
    const int side = i < pair.first_side ? 0 : 1;
    const bool begins = i == 0 || i == pair.first_side;
    low[side] = begins ? min(from, to) : min(low[side], min(from, to));
    high[side] = begins ? max(from, to) : max(high[side], max(from, to));
  }
  const Vec3f apart = max(low[0] - high[1], low[1] - high[0]);
  return max(max(apart.x, apart.y), apart.z) <= distance;
}

/// The mean displacement of all that can be pushed.
Vec3f PairSystem::mean_move(const PairParticles& particles) const {
  Vec3d sum{};
  int count = 0;
  for (const int v : model_.elements.vertices) {
    if (!(particles.positions[v].w > 0)) continue;
    sum += convert<double>(move_of(particles, static_cast<std::size_t>(v)));
    ++count;
  }
  return count > 0 ? convert<float>(sum * (1. / count)) : Vec3f{};
}

/// Whether every vertex ends its move within its box, grown by `margin` around the motion for which lists were made, as seen
/// by one who drifts along with the mean of all: what is apart for him at any time is apart.
bool PairSystem::all_within(const PairParticles& particles, float margin) {
  mean_ = mean_move(particles);
  for (const int v : model_.elements.vertices) {
    const auto i = static_cast<std::size_t>(v);
    const Vec3f low = min(from_[i], to_[i]), high = max(from_[i], to_[i]), start = end_of(particles, i, 0) - drift_,
                end = end_of(particles, i) - drift_ - mean_;
    const Vec3f out = max(max(low - min(start, end), max(start, end) - high), Vec3f{});
    if (!(largest(out) <= margin)) return false;
  }
  return true;
}

/// Sorts candidates by kind and clusters. The order of buckets, and of pairs within one, is that of numbers alone: a pair more
/// or less that is out of reach does not change the order of those that touch.
void PairSystem::fill_buckets() {
  const IntLists* lists[2] = {&finder_.vertex_triangles(), &finder_.edge_edges()};
  const auto each = [&](auto visit) {
    for (int kind = 0; kind < 2; ++kind) {
      const std::vector<int>&first = kind == 0 ? model_.vertex_cluster : model_.edge_cluster,
            &second = kind == 0 ? model_.triangle_cluster : model_.edge_cluster;
      const std::vector<std::uint64_t>& tangled = kind == 0 ? tangled_pairs_ : tangled_edges_;
      for (int a = 0; a + 1 < static_cast<int>(lists[kind]->start.size()); ++a)
        for (const int* b = lists[kind]->begin(a); b != lists[kind]->end(a); ++b)
          if (tangled.empty() || !std::binary_search(tangled.begin(), tangled.end(), key_of(a, *b)))
            visit(a, *b,
                  (static_cast<std::uint64_t>(kind) << 62) | (static_cast<std::uint64_t>(first[a]) << 31) |
                      static_cast<std::uint64_t>(second[*b]));
    }
  };
  // Neighbours in the lists mostly share a bucket: the last one found is tried first, then a search among those known.
  keys_.clear();
  std::size_t count = 0;
  each([&](int, int, std::uint64_t key) {
    ++count;
    if (keys_.empty() || keys_.back().first != key) keys_.emplace_back(key, 0);
  });
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  bucket_of_.clear();
  bucket_of_.reserve(count);
  std::size_t last = 0;
  each([&](int, int, std::uint64_t key) {
    if (keys_[last].first != key)
      last = static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), std::make_pair(key, 0)) - keys_.begin());
    // The count of each, moved on by unique() and sort() from zero.
    bucket_of_.push_back(static_cast<std::int32_t>(last));
  });
  for (const std::int32_t bucket : bucket_of_) ++keys_[bucket].second;
  buckets_.clear();
  std::int32_t first = 0;
  for (const auto& [key, size] : keys_) {
    Bucket bucket{};
    bucket.vertices = key >> 62 == 0;
    bucket.first_cluster = static_cast<int>((key >> 31) & 0x7fffffff);
    bucket.second_cluster = static_cast<int>(key & 0x7fffffff);
    bucket.first = bucket.last = first;
    bucket.margin = not_measured;
    buckets_.push_back(bucket);
    first += size;
  }
  pairs_.resize(count);
  active_.resize(count);
  std::size_t number = 0;
  each([&](int a, int b, std::uint64_t) {
    pairs_[buckets_[bucket_of_[number]].last++] = {a, b, not_measured, -1};
    ++number;
  });
}

void PairSystem::cut_into_tasks() {
  std::size_t tasks = 0;
  for (int bucket = 0; bucket < static_cast<int>(buckets_.size()); ++tasks) {
    if (tasks_.size() <= tasks) tasks_.emplace_back();
    tasks_[tasks].first = bucket;
    const std::int32_t first = buckets_[bucket].first;
    do ++bucket;
    while (bucket < static_cast<int>(buckets_.size()) && buckets_[bucket].last - first <= pairs_in_a_task);
    tasks_[tasks].last = bucket;
  }
  tasks_.resize(tasks);
}

void PairSystem::rebuild(Executor& executor, const PairParticles& particles) {
  from_.resize(model_.rest.size());
  to_.resize(model_.rest.size());
  mean_ = mean_move(particles);
  drift_ = {};
  for (std::size_t i = 0; i < from_.size(); ++i) {
    from_[i] = end_of(particles, i, 0);
    to_[i] = from_[i] + (end_of(particles, i) - from_[i] - mean_) * particles.ahead;
  }
  finder_.find(executor, from_, to_, model_.radius, true);
  fill_buckets();
  cut_into_tasks();
  vertex_sum_.assign(vertex_move_.size(), 0.f);
  triangle_sum_.assign(triangle_move_.size(), 0.f);
  edge_sum_.assign(edge_move_.size(), 0.f);
  listed_ = true;
  ++counts_.rebuilds;
  counts_.candidates = static_cast<std::int64_t>(pairs_.size());
}

}  // namespace pliant
