#include "collision/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr int pairs_in_a_task = 4096;
/// Bounds are sums of floats: pairs are dismissed only when they are out of reach by more than this.
constexpr float cull_slack = 1.0001f;
/// Pairs stay active while all moves add up to less than this share of the skin.
constexpr float share_of_skin = 0.25f;
/// Nearer than any distance: to be measured before anything else.
constexpr float not_measured = -1e30f;
/// A contact keeps no more than this share of the distance that its primitives have at rest.
constexpr double share_of_rest = 0.9;
/// What the filter keeps, as a share of the thickness; and at least so many roundings of the positions.
constexpr float least_share = 0.05f, least_roundings = 32, rounding = 6e-8f;
/// Bounds of distances are floats: this much is allowed for their rounding.
constexpr float bound_slack = 1.0001f;
/// Sums of moves that are taken off again later are rounded some ten times.
constexpr float sum_slack = 1 - 1e-6f;
/// Places as seen by one who drifts along are rounded this often, at most.
constexpr float place_roundings = 16;
/// Rounds in which moves are shortened by as much as they must; after them offenders stay where they are.
constexpr int rounds_of_shares = 3;

std::uint64_t key_of(int a, int b) { return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b); }

void sort_out(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// For each vertex the triangles at it, ascending.
IntLists triangles_around(const ContactElements& elements) {
  IntLists out;
  out.start.assign(static_cast<std::size_t>(elements.vertex_count) + 1, 0);
  for (const Triangle& t : elements.triangles)
    for (const int v : t) ++out.start[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(3 * elements.triangles.size());
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t t = 0; t < elements.triangles.size(); ++t)
    for (const int v : elements.triangles[t]) out.items[next[v]++] = static_cast<int>(t);
  return out;
}

Vec3f end_of(const PairParticles& particles, std::size_t i, float times = 1) {
  const Record &x = particles.positions[i], &d = particles.displacements[i];
  return {x.x + d.x * times, x.y + d.y * times, x.z + d.z * times};
}

/// By how much a position changes: not quite by the displacement, which it can't hold.
Vec3f move_of(const PairParticles& particles, std::size_t i) { return end_of(particles, i) - end_of(particles, i, 0); }

bool moves_at_all(const Record& d) { return d.x != 0 || d.y != 0 || d.z != 0; }

}  // namespace

PairSystem::PairSystem(const PairModel& model)
    : model_(model), finder_(model.elements), intersections_(model.elements.triangles, model.elements.vertex_count) {
  const auto clusters = static_cast<std::size_t>(model.clusters);
  vertex_move_.resize(model.rest.size());
  triangle_move_.resize(model.elements.triangles.size());
  edge_move_.resize(model.elements.edges.size());
  cluster_move_.resize(clusters);
  cluster_largest_.resize(clusters);
  cluster_vertices_.resize(clusters);
  cluster_triangles_.resize(clusters);
  cluster_edges_.resize(clusters);
  for (const int v : model.elements.vertices) cluster_vertices_[model.vertex_cluster[v]].push_back(v);
  for (std::size_t i = 0; i < triangle_move_.size(); ++i)
    cluster_triangles_[model.triangle_cluster[i]].push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < edge_move_.size(); ++i) cluster_edges_[model.edge_cluster[i]].push_back(static_cast<int>(i));
  share_.assign(model.rest.size(), 1.f);
}

// ---------------------------------------------------------------- lists

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

// ---------------------------------------------------------------- bounds of distances

void PairSystem::measure_moves(Executor& executor, const PairParticles& particles) {
  constexpr int clusters_in_a_task = 16;
  const ContactElements& elements = model_.elements;
  const int tasks = (model_.clusters + clusters_in_a_task - 1) / clusters_in_a_task;
  executor.parallel_for("contact bounds", tasks, [&](int task) {
    for (int c = task * clusters_in_a_task; c < std::min(model_.clusters, (task + 1) * clusters_in_a_task); ++c) {
      Vec3f sum{};
      for (const int v : cluster_vertices_[c]) sum += move_of(particles, static_cast<std::size_t>(v));
      const Vec3f mean = cluster_move_[c] = sum * (1.f / static_cast<float>(cluster_vertices_[c].size()));
      const auto relative = [&](int v) {
        return length(move_of(particles, static_cast<std::size_t>(v)) - mean) * bound_slack + 1e-12f;
      };
      float most = 0;
      for (const int v : cluster_vertices_[c]) most = max(most, vertex_move_[v] = relative(v));
      for (const int t : cluster_triangles_[c]) {
        const Triangle& corners = elements.triangles[t];
        triangle_move_[t] = max(max(relative(corners[0]), relative(corners[1])), relative(corners[2]));
        most = max(most, triangle_move_[t]);
      }
      for (const int e : cluster_edges_[c]) {
        edge_move_[e] = max(relative(elements.edges[e][0]), relative(elements.edges[e][1]));
        most = max(most, edge_move_[e]);
      }
      cluster_largest_[c] = most;
    }
  });
}

/// The substep's moves have been made.
void PairSystem::settle_moves() {
  const auto add = [](std::vector<float>& to, const std::vector<float>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = (to[i] + from[i]) * (1 + 1e-7f);
  };
  add(vertex_sum_, vertex_move_);
  add(triangle_sum_, triangle_move_);
  add(edge_sum_, edge_move_);
  for (Bucket& bucket : buckets_) {
    const float means = between(bucket);
    bucket.between_sum = (bucket.between_sum + means) * (1 + 1e-7f);
    bucket.growth =
        (bucket.growth + (cluster_largest_[bucket.first_cluster] + cluster_largest_[bucket.second_cluster] + means)) *
        (1 + 1e-7f);
  }
}

/// How far the means of two clusters move against each other in this substep.
float PairSystem::between(const Bucket& bucket) const {
  if (bucket.first_cluster == bucket.second_cluster) return 0;
  return length(cluster_move_[bucket.first_cluster] - cluster_move_[bucket.second_cluster]) * bound_slack;
}

/// What both sides of a pair have moved since lists were made, this substep left out.
float PairSystem::sums(const Bucket& bucket, std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  return (bucket.vertices ? vertex_sum_[p.a] + triangle_sum_[p.b] : edge_sum_[p.a] + edge_sum_[p.b]) + bucket.between_sum;
}

/// What they move in this substep.
float PairSystem::moves(const Bucket& bucket, std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  return (bucket.vertices ? vertex_move_[p.a] + triangle_move_[p.b] : edge_move_[p.a] + edge_move_[p.b]) + between(bucket);
}

/// Distances of the task's `near`, sixteen at a time; visit(pair, stencil, batch, lane) each.
template <class Visit>
void PairSystem::measure(const Bucket& bucket, Task& task, const PairParticles& particles, Visit visit) {
  task.stencils.clear();
  for (const std::int32_t p : task.near) task.stencils.push_back(stencil(bucket, p));
  PairBatch batch;
  for (std::size_t i = 0; i < task.near.size(); i += 16) {
    const int count = static_cast<int>(std::min<std::size_t>(16, task.near.size() - i));
    pair_distances(&task.stencils[i], count, particles.positions, batch);
    for (int lane = 0; lane < count; ++lane) {
      const std::int32_t p = task.near[i + lane];
      pairs_[p].reach = (batch.at_least[lane] + sums(bucket, p)) * sum_slack;
      visit(p, task.stencils[i + lane], batch, lane);
    }
  }
}

/// Sees to it that all pairs of the bucket that can matter in this substep are active: those that can come within their
/// thickness before the moves add up to the margin.
void PairSystem::activate(Bucket& bucket, Task& task, const PairParticles& particles) {
  const float now = cluster_largest_[bucket.first_cluster] + cluster_largest_[bucket.second_cluster] + between(bucket);
  if (bucket.growth + now <= bucket.margin) return;
  bucket.growth = 0;
  bucket.margin = max(share_of_skin * (model_.radius - model_.largest_thickness), 1.1f * now);
  const float thickness = material(bucket).thickness;
  const float near = max(cull_slack * thickness, 2 * least_of(thickness)) + bucket.margin;
  task.near.clear();
  for (std::int32_t p = bucket.first; p < bucket.last; ++p)
    if (pairs_[p].reach - sums(bucket, p) <= near) task.near.push_back(p);
  bucket.active_last = bucket.first;
  measure(bucket, task, particles, [&](std::int32_t p, const PairStencil&, const PairBatch& at, int lane) {
    if (at.at_least[lane] <= near) active_[bucket.active_last++] = p;
  });
}

/// Active pairs that can be nearer than `within` at the substep's end.
void PairSystem::collect_near(Bucket& bucket, Task& task, float within) {
  task.near.clear();
  for (std::int32_t i = bucket.first; i < bucket.active_last; ++i)
    if (pairs_[active_[i]].reach - sums(bucket, active_[i]) - moves(bucket, active_[i]) <= within)
      task.near.push_back(active_[i]);
}

// ---------------------------------------------------------------- contacts

void PairSystem::detect_bucket(Bucket& bucket, Task& task, const PairParticles& particles) {
  activate(bucket, task, particles);
  if (bucket.active_last == bucket.first) return;
  const PairMaterial& of = material(bucket);
  collect_near(bucket, task, cull_slack * of.thickness);
  measure(bucket, task, particles, [&](std::int32_t pair, const PairStencil& four, const PairBatch& at, int lane) {
    Pair& p = pairs_[pair];
    PairMaterial kept = of;
    const float nearest = at.distance[lane] * (1 - 1e-5f) - moves(bucket, pair);
    if (!(at.distance[lane] > 0) || nearest > kept.thickness) return;
    if (p.rest < 0) p.rest = static_cast<float>(share_of_rest * pair_distance(four, model_.rest.data()).distance);
    kept.thickness = min(kept.thickness, p.rest);
    if (nearest <= kept.thickness && paths_within(four, particles, kept.thickness))
      task.contacts.push_back(make_contact(four, at, lane, kept, particles.h));
  });
}

void PairSystem::detect(Executor& executor, const PairParticles& particles) {
  contacts_.clear();
  if (!is_finite(particles)) return;
  if (!listed_ || !all_within(particles, margin_beyond(model_.largest_thickness))) rebuild(executor, particles);
  measure_moves(executor, particles);
  executor.parallel_for("detect contacts", static_cast<int>(tasks_.size()), [&](int number) {
    Task& task = tasks_[number];
    task.contacts.clear();
    for (int b = task.first; b < task.last; ++b) detect_bucket(buckets_[b], task, particles);
  });
  for (const Task& task : tasks_) contacts_.insert(contacts_.end(), task.contacts.begin(), task.contacts.end());
}

void PairSystem::project(const PairParticles& particles) {
  for (PairContact& contact : contacts_)
    project_contact(contact, particles.positions, particles.remainders, particles.displacements);
}

void PairSystem::respond(const Record* positions, Record* velocities, FunctionRef<Vec3f(int body)> gravity) const {
  for (const PairContact& contact : contacts_) {
    Vec3f missing{};
    for (int i = 0; i < 4; ++i)
      if (positions[contact.vertex[i]].w > 0) missing += gravity(model_.vertex_body[contact.vertex[i]]) * contact.weight[i];
    respond_to_contact(contact, positions, velocities, missing);
  }
}

// ---------------------------------------------------------------- the filter

void PairSystem::filter_bucket(Bucket& bucket, Task& task, const PairParticles& particles) {
  activate(bucket, task, particles);
  if (bucket.active_last == bucket.first) return;
  collect_near(bucket, task, least_of(material(bucket).thickness));
  for (const std::int32_t p : task.near) filter_pair(bucket, p, particles, task);
}

void PairSystem::filter_pair(const Bucket& bucket, std::int32_t pair, const PairParticles& particles, Task& task) {
  const PairStencil four = stencil(bucket, pair);
  const float least = least_of(material(bucket).thickness);
  if (!paths_within(four, particles, least)) return;
  const PairDistance at = pair_distance(four, particles.positions);
  // What an old bound could not dismiss and a new one does is left alone: bounds only save work.
  if (static_cast<float>(at.distance) * sum_slack - moves(bucket, pair) > least) return;
  SeparatingSlab slab;
  std::array<float, 4> shares{1, 1, 1, 1};
  const Separation found =
      plan_separation(four, at, particles.positions, particles.displacements, double(least), slab, shares);
  if (found == Separation::free) return;
  if (found == Separation::hopeless) ++task.hopeless;
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
    // What moved farther than was foreseen is looked for around the moves as they are now.
    if (!listed_ || !all_within(particles, margin_beyond(least_of(model_.largest_thickness)))) rebuild(executor, particles);
    measure_moves(executor, particles);
    executor.parallel_for("filter moves", static_cast<int>(tasks_.size()), [&](int number) {
      Task& task = tasks_[number];
      task.slabs.clear();
      task.shares.clear();
      task.hopeless = 0;
      for (int b = task.first; b < task.last; ++b) filter_bucket(buckets_[b], task, particles);
    });
    if (!shorten(particles, round >= rounds_of_shares)) break;
  }
  for (const Task& task : tasks_) counts_.hopeless += task.hopeless;
  std::sort(shortened_.begin(), shortened_.end());
  counts_.shortened += std::unique(shortened_.begin(), shortened_.end()) - shortened_.begin();
}

void PairSystem::filter(Executor& executor, const PairParticles& particles) {
  counts_.contacts = 0;
  for (const PairContact& contact : contacts_) counts_.contacts += contact.push > 0 ? 1 : 0;
  if (!is_finite(particles)) return;
  if (model_.filter) {
    keep_apart(executor, particles);
  } else {
    measure_moves(executor, particles);
  }
  settle_moves();
  drift_ += mean_move(particles);
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
  tangled_pairs_.clear();
  tangled_edges_.clear();
  const auto edge_number = [&](int a, int b) {
    const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
    const auto& edges = model_.elements.edges;
    const auto at = std::lower_bound(edges.begin(), edges.end(), edge);
    return at != edges.end() && *at == edge ? static_cast<int>(at - edges.begin()) : -1;
  };
  counts_.tangled = static_cast<std::int64_t>(tangles_.size());
  const IntLists around = tangles_.empty() ? IntLists{} : triangles_around(model_.elements);
  for (const Intersection& tangle : tangles_) {
    const Triangle& t = model_.elements.triangles[tangle.triangle];
    tangled_pairs_.push_back(key_of(tangle.a, tangle.triangle));
    tangled_pairs_.push_back(key_of(tangle.b, tangle.triangle));
    const int crossing = edge_number(tangle.a, tangle.b);
    for (int k = 0; k < 3; ++k) {
      const int side = edge_number(t[k], t[(k + 1) % 3]);
      tangled_edges_.push_back(key_of(std::min(crossing, side), std::max(crossing, side)));
    }
    // The triangle's corners against the triangles of the edge.
    for (const int* other = around.begin(tangle.a); other != around.end(tangle.a); ++other) {
      const Triangle& o = model_.elements.triangles[*other];
      if (o[0] != tangle.b && o[1] != tangle.b && o[2] != tangle.b) continue;
      for (const int corner : t) tangled_pairs_.push_back(key_of(corner, *other));
    }
  }
  sort_out(tangled_pairs_);
  sort_out(tangled_edges_);
}

void PairSystem::begin_frame(const Record* positions, bool anew) {
  const std::int64_t candidates = counts_.candidates, tangled = counts_.tangled, hopeless = counts_.hopeless;
  counts_ = {};
  counts_.candidates = candidates;
  counts_.tangled = tangled;
  // Clean pairs stay clean, unless nothing kept them: what has crossed is then exempt, as it would be in a state put back.
  const bool kept_apart = model_.filter && hopeless == 0;
  if (!anew && tangles_.empty() && kept_apart) return;
  find_tangles(positions);
  listed_ = false;
}

}  // namespace pliant
