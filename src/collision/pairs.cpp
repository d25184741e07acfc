#include "collision/pairs.h"

#include <algorithm>

#include "collision/pair_bounds.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Bounds are sums of floats: pairs are dismissed only when they are out of reach by more than this.
constexpr float cull_slack = 1.0001f;
/// Pairs stay active while all moves add up to less than this share of the skin.
constexpr float share_of_skin = 0.25f;
/// A contact keeps no more than this share of the distance that its primitives have at rest.
constexpr double share_of_rest = 0.9;

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

}  // namespace pliant
