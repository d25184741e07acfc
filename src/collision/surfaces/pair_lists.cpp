// The lists of PairSystem: of two clusters that are near one another, the pairs that are.
//
// A list is made where it is used, when the moves of its two clusters since it was made have used up its margin: sixteen
// boxes are compared with one at once, those of one cluster that come near the other with those of the other that do.
#include <algorithm>

#include "collision/surfaces/pair_bounds.h"

namespace pliant {

namespace {

/// How far clusters may move against each other, as a share of what the radius leaves beyond the thickness, before their pairs
/// are listed anew: longer lists against fewer looks.
constexpr float skin_share = 1.5f;
/// Clearance is looked for up to so many skins beyond what is of interest, and is of use from so many on.
constexpr float most_skins = 1.25f, fewest_skins = 0.2f;

/// How far two boxes are apart along the axis where they are farthest.
float distance_between(const BoxBounds& a, const BoxBounds& b) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z);
}

BoxBounds box_at(const std::vector<float> (&box)[6], int i) {
  return {{box[0][i], box[1][i], box[2][i]}, {box[3][i], box[4][i], box[5][i]}};
}

BoxRows rows_of(std::vector<float> (&box)[6]) {
  return {{box[0].data(), box[1].data(), box[2].data(), box[3].data(), box[4].data(), box[5].data()}};
}

}  // namespace

/// Of a vertex and a triangle, or of two edges.
PairStencil PairSystem::stencil(bool of_vertices, std::int32_t a, std::int32_t b) const {
  if (of_vertices) {
    const Triangle& t = model_.elements.triangles[b];
    return {{a, t[0], t[1], t[2]}, 1};
  }
  const auto &e = model_.elements.edges[a], &f = model_.elements.edges[b];
  return {{e[0], e[1], f[0], f[1]}, 2};
}

/// How far clusters may move against each other before their pairs are listed anew [m].
float PairSystem::skin() const { return skin_share * (model_.radius - model_.largest_thickness); }

/// By how much the distances of sixteen pairs fall at most in this substep, and how far apart their paths are, as seen by one
/// who drifts along.
void PairSystem::find_paths(const Between& clusters, const PairStencils& pairs, const PairParticles& particles,
                            PairPaths& out) const {
  unsigned swapped = 0;
  if (clusters.first != clusters.second)
    for (int lane = 0; lane < 16; ++lane)
      swapped |= (model_.vertex_cluster[pairs.vertex[0][lane]] != clusters.first ? 1U : 0U) << lane;
  kernels_.paths(pairs, clusters.of_vertices ? 1 : 2, particles,
                 {&motions_[clusters.first], &motions_[clusters.second], swapped, mean_}, out);
  const float apart = neighbours_[clusters.neighbours].apart;
  for (float& falls : out.falls) falls += apart;
}

/// Whether one side of a pair is lost in the body of the other.
bool PairSystem::is_lost(const PairStencil& pair) const {
  if (!untangler_ || !untangler_->is_busy()) return false;
  const int first = model_.vertex_body[pair.vertex[0]], second = model_.vertex_body[pair.vertex[pair.first_side]];
  bool lost = false;
  for (int i = 0; i < 4; ++i) lost = lost || untangler_->is_lost(pair.vertex[i], i < pair.first_side ? second : first);
  return lost;
}

bool PairSystem::is_tangled(const PairStencil& pair) const {
  if (is_lost(pair)) return true;
  if (tangled_.empty()) return false;
  const auto& v = pair.vertex;
  return std::binary_search(tangled_.begin(), tangled_.end(),
                            std::array<std::int32_t, 5>{v[0], v[1], v[2], v[3], pair.first_side});
}

// ---------------------------------------------------------------- when

/// Sees to it that all pairs that can matter in this substep are listed.
void PairSystem::bring_up_to_date(Executor& executor, const PairParticles& particles) {
  if (listed_ && has_gone_far()) listed_ = false;
  if (!listed_ || !clusters_hold()) list_clusters();
  const int tasks = static_cast<int>(tasks_.size());
  const auto is_stale = [](const Task& task) { return !task.stale.empty(); };
  for (Task& task : tasks_) find_stale(task);
  if (std::none_of(tasks_.begin(), tasks_.end(), is_stale)) return;
  clear_stale(executor, particles);
  fit_boxes(executor, particles);
  executor.parallel_for("list pairs", tasks, [&](int number) {
    for (const std::int32_t bucket : tasks_[number].stale) refresh(buckets_[bucket], tasks_[number], particles);
  });
  counts_.candidates = pairs_of_surroundings_;
  for (const Bucket& bucket : buckets_) counts_.candidates += static_cast<std::int64_t>(bucket.pairs.size());
}

void PairSystem::find_stale(Task& task) {
  task.stale.clear();
  for (int b = task.first; b < task.last; ++b) {
    const Bucket& bucket = buckets_[b];
    if (!(moved(bucket) + moves(bucket) <= bucket.margin)) task.stale.push_back(b);
  }
}

/// Takes from what is stale the buckets in which nothing can be near for a while: they are empty until then.
void PairSystem::clear_stale(Executor& executor, const PairParticles& particles) {
  ask_for_clearance(executor, particles);
  for (Task& task : tasks_) {
    const auto is_clear_now = [&](std::int32_t number) { return is_clear(buckets_[number]); };
    task.stale.erase(std::remove_if(task.stale.begin(), task.stale.end(), is_clear_now), task.stale.end());
  }
  for (const std::int32_t bucket : asked_) neighbours_[buckets_[bucket].neighbours].is_asked = false;
  asked_.clear();
}

/// By the distances of vertices within one surface, of boxes around paths elsewhere.
bool PairSystem::is_clear(Bucket& bucket) const {
  const Neighbours& pair = neighbours_[bucket.neighbours];
  const float apart = pair.is_asked ? pair.clearance
                                    : distance_between(path_box(bucket.first), path_box(bucket.second)) * (1 - 1e-5f),
              least = pair.is_asked ? max(fewest_skins * skin(), 1.1f * pair.moves) : skin() * bound_slack,
              room = apart - care_of(bucket);
  if (!(room > least)) return false;
  bucket.listed_at = pair.moved;
  bucket.pairs.clear();
  bucket.reach.clear();
  bucket.least_reach = out_of_reach;
  bucket.margin = room;
  return true;
}

/// The clearance of the clusters of all buckets that are stale.
void PairSystem::ask_for_clearance(Executor& executor, const PairParticles& particles) {
  placed_.assign(static_cast<std::size_t>(model_.clusters), 0);
  for (const Task& task : tasks_)
    for (const std::int32_t number : task.stale) {
      Neighbours& pair = neighbours_[buckets_[number].neighbours];
      if (!pair.is_joined || pair.is_asked) continue;
      pair.is_asked = true;
      asked_.push_back(number);
      placed_[pair.a] = placed_[pair.b] = 1;
    }
  executor.parallel_for("place corners", model_.clusters, [&](int c) {
    if (placed_[c] != 0) clearance_.place(kernels_, c, particles.positions);
  });
  const std::size_t tasks = tasks_.size();
  executor.parallel_for("look for clearance", static_cast<int>(tasks), [&](int number) {
    const auto task = static_cast<std::size_t>(number);
    for (std::size_t i = asked_.size() * task / tasks; i < asked_.size() * (task + 1) / tasks; ++i) {
      const Bucket& bucket = buckets_[asked_[i]];
      neighbours_[bucket.neighbours].clearance = clearance_.between(
          kernels_, bucket.first, bucket.second, care_of(bucket) + most_skins * skin(), tasks_[task].batches);
    }
  });
}

/// Boxes around the paths of all that lists are made of.
void PairSystem::fit_boxes(Executor& executor, const PairParticles& particles) {
  for (std::vector<char>& wanted : wanted_) std::fill(wanted.begin(), wanted.end(), 0);
  for (const Task& task : tasks_)
    for (const std::int32_t number : task.stale) {
      const Bucket& bucket = buckets_[number];
      wanted_[bucket.of_vertices ? vertex_kind : edge_kind][bucket.first] = 1;
      wanted_[bucket.of_vertices ? triangle_kind : edge_kind][bucket.second] = 1;
    }
  executor.parallel_for("fit boxes", model_.clusters, [&](int c) {
    for (int kind = 0; kind < 3; ++kind)
      if (wanted_[kind][c] != 0) fit_boxes_of(elements_[kind], c, particles);
  });
}

void PairSystem::fit_boxes_of(Elements& of, int cluster, const PairParticles& particles) {
  const int first = of.start[cluster], last = of.start[cluster + 1];
  kernels_.fit_boxes({{of.corner[0].data(), of.corner[1].data(), of.corner[2].data()}, of.corners}, first, last, particles,
                     mean_, rows_of(of.box));
  for (int i = first; i < last; i += 16) {
    BoxBounds all = box_at(of.box, i);
    for (int k = i + 1; k < i + 16; ++k) all = {min(all.low, box_at(of.box, k).low), max(all.high, box_at(of.box, k).high)};
    of.batch_box[i / 16] = all;
  }
  for (int k = 0; k < 6; ++k)  // what fills up overlaps nothing
    std::fill(of.box[k].begin() + first + of.count[cluster], of.box[k].begin() + last, k < 3 ? 3e38f : -3e38f);
}

// ---------------------------------------------------------------- how

/// Lists the pairs of a bucket whose paths in this substep come near, and with them all that can until the moves add up to
/// the margin. What moves farther than that in one substep is listed for this one alone.
void PairSystem::refresh(Bucket& bucket, Task& task, const PairParticles& particles) {
  const Neighbours& pair = neighbours_[bucket.neighbours];
  const float care = care_of(bucket), search = skin() * bound_slack;
  bucket.listed_at = pair.moved;
  bucket.pairs.clear();
  bucket.reach.clear();
  bucket.least_reach = out_of_reach;
  const bool is_fast = 1.1f * pair.moves > skin();
  bucket.margin = is_fast ? -1 : skin();
  find_pairs(bucket, is_fast ? care : care + search, task);
  keep_near(bucket, care + max(search, 1.1f * pair.moves), task, particles);
}

/// Into task.found: pairs whose boxes come within `reach`, surroundings left out.
void PairSystem::find_pairs(const Bucket& bucket, float reach, Task& task) {
  task.found.clear();
  Elements &rows = elements_[bucket.of_vertices ? vertex_kind : edge_kind],
           &columns = elements_[bucket.of_vertices ? triangle_kind : edge_kind];
  const bool once = !bucket.of_vertices && bucket.first == bucket.second;
  const BoxBounds far = path_box(bucket.second).grown(reach);
  const float far_box[6] = {far.low.x, far.low.y, far.low.z, far.high.x, far.high.y, far.high.z};
  const int last = columns.start[bucket.second + 1] / 16;
  for (int sixteen = rows.start[bucket.first] / 16; sixteen < rows.start[bucket.first + 1] / 16; ++sixteen) {
    const BoxBounds own = rows.batch_box[sixteen].grown(reach);
    if (!overlap(rows.batch_box[sixteen], far)) continue;
    task.batches.clear();
    for (int b = once ? sixteen : columns.start[bucket.second] / 16; b < last; ++b)
      if (overlap(own, columns.batch_box[b])) task.batches.push_back(b);
    if (task.batches.empty()) continue;
    task.hits.resize(std::max(task.hits.size(), 256 * task.batches.size()));
    const int count =
        kernels_.find_overlaps({rows_of(rows.box), 16 * sixteen, reach, far_box, rows_of(columns.box), task.batches.data(),
                                static_cast<int>(task.batches.size()), rows.left_out.data(), rows.left_out_start.data()},
                               task.hits.data());
    for (int k = 0; k < count; ++k)
      if (const auto [i, j] = task.hits[k]; !once || j > i) add_pair(bucket, rows.item[i], columns.item[j], task);
  }
}

/// Unless the two share a vertex.
void PairSystem::add_pair(const Bucket& bucket, std::int32_t a, std::int32_t b, Task& task) const {
  const ContactElements& all = model_.elements;
  if (bucket.of_vertices) {
    const Triangle& t = all.triangles[b];
    if (t[0] == a || t[1] == a || t[2] == a) return;
  } else {
    const auto &e = all.edges[a], &f = all.edges[b];
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    if (b < a) std::swap(a, b);
  }
  task.found.push_back({stencil(bucket.of_vertices, a, b).vertex, -1});
}

}  // namespace pliant
