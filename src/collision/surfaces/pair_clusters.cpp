// The clusters of PairSystem: how they move, and which are near one another. Where two are not, nothing is done about anything
// in them; where they are, their pairs are listed in buckets (pair_lists.cpp).
#include <algorithm>
#include <tuple>

#include "collision/surfaces/pair_bounds.h"

namespace pliant {

namespace {

constexpr int buckets_in_a_task = 64, clusters_in_a_task = 16;
/// How far clusters may travel, in radii of the lists, before it is found out anew which are near: few more buckets against few
/// more looks.
constexpr float travel_over_radius = 2;

}  // namespace

PairSystem::PairSystem(const PairModel& model, const PairKernels& kernels)
    : model_(model), kernels_(kernels), intersections_(model.elements.triangles, model.elements.vertex_count) {
  lay_out_elements(vertex_kind, 1);
  lay_out_elements(edge_kind, 2);
  lay_out_elements(triangle_kind, 3);
  lay_out_vertices();
  find_surroundings();
  const auto clusters = static_cast<std::size_t>(model.clusters);
  motions_.resize(clusters);
  travel_.resize(clusters);
  extent_.resize(clusters);
  cluster_boxes_.resize(clusters);
  share_.assign(model.rest.size(), 1.f);
  if (model.untangling_speed > 0) untangler_ = std::make_unique<Untangler>(model);
}

// ---------------------------------------------------------------- moves

/// How all clusters move in this substep; from that the mean of all, and whether their numbers can be reckoned with.
void PairSystem::measure_moves(Executor& executor, const PairParticles& particles) {
  const int tasks = (model_.clusters + clusters_in_a_task - 1) / clusters_in_a_task;
  executor.parallel_for("contact bounds", tasks, [&](int task) {
    for (int c = task * clusters_in_a_task; c < std::min(model_.clusters, (task + 1) * clusters_in_a_task); ++c)
      if (const int count = cluster_start_[c + 1] - cluster_start_[c]; count > 0)
        kernels_.measure_cluster(cluster_vertices_.data() + cluster_start_[c], count, particles, motions_[c]);
  });
  Vec3d sum{};
  double count = 0;
  is_bounded_ = true;
  for (const ClusterMotion& motion : motions_) {
    sum += convert<double>(motion.sum);
    count += double(motion.movable);
    is_bounded_ = is_bounded_ && motion.is_bounded;
  }
  mean_ = count > 0 ? convert<float>(sum * (1. / count)) : Vec3f{};
  if (!is_bounded_) listed_ = false;
  for (Neighbours& pair : neighbours_) measure_between(pair);
}

/// Two clusters as seen from halfway between them: one that goes along and turns with the mean of both.
void PairSystem::measure_between(Neighbours& pair) const {
  const ClusterMotion &a = motions_[pair.a], &b = motions_[pair.b];
  pair.apart = 0;
  if (pair.a != pair.b) {
    const Vec3f moves = a.mean - b.mean, turns = (a.spin + b.spin) * 0.5f, arm = a.centre - b.centre;
    const float rounded = 1e-6f * (length(moves) + length(turns) * length(arm));
    pair.apart =
        (length(moves - cross(turns, arm)) + 0.5f * length(a.spin - b.spin) * (a.radius + b.radius)) * bound_slack +
        rounded;
  }
  pair.moves = a.largest + b.largest + pair.apart;
}

/// How far anything in a cluster goes in this substep, against the mean of all.
float PairSystem::travel_of(std::size_t cluster) const {
  const ClusterMotion& motion = motions_[cluster];
  return (length(motion.mean - mean_) + length(motion.spin) * motion.radius) * bound_slack + motion.largest;
}

/// The substep's moves have been made.
void PairSystem::settle_moves() {
  for (std::size_t c = 0; c < motions_.size(); ++c) travel_[c] = (travel_[c] + travel_of(c)) * (1 + 1e-6f);
  for (Neighbours& pair : neighbours_) pair.moved = (pair.moved + pair.moves) * (1 + 1e-6f);
}

// ---------------------------------------------------------------- which are near one another

/// Whether all clusters that are near one another in this substep are neighbours already.
bool PairSystem::clusters_hold() const {
  const float room = travel_over_radius * model_.radius, drifted = largest(mean_);
  for (std::size_t c = 0; c < motions_.size(); ++c) {
    const float rounded = place_roundings * rounding * (motions_[c].extent + drifted);
    if (!(travel_[c] + travel_of(c) <= room - rounded)) return false;
  }
  return true;
}

/// Whether a cluster is so much farther from the origin that its roundings outgrow what lists allow for.
bool PairSystem::has_gone_far() const {
  for (std::size_t c = 0; c < motions_.size(); ++c)
    if (!(motions_[c].extent <= 2 * extent_[c])) return true;
  return false;
}

/// A box around the paths of all of a cluster, as seen by one who drifts along with the mean of all.
BoxBounds PairSystem::path_box(std::size_t cluster) const {
  const ClusterMotion& m = motions_[cluster];
  return {min(m.low[0], m.low[1] - mean_), max(m.high[0], m.high[1] - mean_)};
}

/// Neighbours are all whose boxes around this substep's paths would come within the radius if each travelled as far as it may,
/// and all that share surroundings.
void PairSystem::list_clusters() {
  for (std::size_t c = 0; c < motions_.size(); ++c)
    cluster_boxes_[c] = path_box(c).grown((0.5f + travel_over_radius) * model_.radius);
  cluster_tree_.build(cluster_boxes_);
  std::vector<Neighbours> before = std::move(neighbours_);
  neighbours_.clear();
  const auto add = [&](int a, int b) {
    const int of_a = model_.cluster_body[a], of_b = model_.cluster_body[b];
    if (model_.meets[static_cast<std::size_t>(of_a) * model_.bodies + of_b] == 0) return;
    neighbours_.push_back({std::min(a, b), std::max(a, b)});
  };
  for (int c = 0; c < model_.clusters; ++c) add(c, c);
  cluster_tree_.self_pairs(add);
  for (const Surroundings& of : surroundings_) add(of.first, of.second);
  const auto less = [](const Neighbours& x, const Neighbours& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); };
  std::sort(neighbours_.begin(), neighbours_.end(), less);
  const auto same = [](const Neighbours& x, const Neighbours& y) { return x.a == y.a && x.b == y.b; };
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end(), same), neighbours_.end());
  number_surroundings(before);
  make_buckets(before);
  cut_into_tasks();
  std::fill(travel_.begin(), travel_.end(), 0.f);
  if (!listed_)
    for (std::size_t c = 0; c < motions_.size(); ++c) extent_[c] = motions_[c].extent;
  for (Neighbours& pair : neighbours_) measure_between(pair);
  listed_ = true;
  ++counts_.rebuilds;
}

/// Tells surroundings which neighbours they belong to.
void PairSystem::number_surroundings(const std::vector<Neighbours>& old) {
  const auto less = [](const Neighbours& x, const Neighbours& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); };
  for (Surroundings& of : surroundings_) {
    if (listed_) of.listed_at -= old[of.neighbours].moved;
    if (!listed_) of.least_reach = not_measured;
    const Neighbours wanted{std::min(of.first, of.second), std::max(of.first, of.second)};
    of.neighbours =
        static_cast<int>(std::lower_bound(neighbours_.begin(), neighbours_.end(), wanted, less) - neighbours_.begin());
    neighbours_[of.neighbours].is_joined = true;
  }
  if (!listed_) std::fill(block_reach_.begin(), block_reach_.end(), not_measured);
}

/// Buckets in the order of kind and clusters, so that one more or less changes no order of those that touch. Those that were
/// there stay as they are, unless all is to be looked at anew.
void PairSystem::make_buckets(const std::vector<Neighbours>& old) {
  std::vector<Bucket> before = std::move(buckets_);
  buckets_.clear();
  std::size_t next = 0;
  const auto add = [&](bool of_vertices, int first, int second, int number) {
    const Kind rows = of_vertices ? vertex_kind : edge_kind, columns = of_vertices ? triangle_kind : edge_kind;
    if (elements_[rows].count[first] == 0 || elements_[columns].count[second] == 0) return;
    Bucket bucket{};
    bucket.first = first;
    bucket.second = second;
    bucket.of_vertices = of_vertices;
    bucket.neighbours = number;
    const auto key = [](const Bucket& b) { return std::make_tuple(!b.of_vertices, b.first, b.second); };
    while (next < before.size() && key(before[next]) < key(bucket)) ++next;
    if (listed_ && next < before.size() && key(before[next]) == key(bucket)) {
      Bucket& same = before[next];
      bucket.listed_at = same.listed_at - old[same.neighbours].moved;
      bucket.margin = same.margin;
      bucket.least_reach = same.least_reach;
      bucket.pairs = std::move(same.pairs);
      bucket.reach = std::move(same.reach);
    }
    buckets_.push_back(std::move(bucket));
  };
  // Others of each cluster, ascending as neighbours are.
  partners_.resize(static_cast<std::size_t>(model_.clusters));
  for (auto& list : partners_) list.clear();
  for (int i = 0; i < static_cast<int>(neighbours_.size()); ++i) {
    const Neighbours& pair = neighbours_[i];
    partners_[pair.a].push_back({pair.b, i});
    if (pair.a != pair.b) partners_[pair.b].push_back({pair.a, i});
  }
  for (int c = 0; c < model_.clusters; ++c)
    for (const auto& [other, number] : partners_[c]) add(true, c, other, number);
  for (int i = 0; i < static_cast<int>(neighbours_.size()); ++i) add(false, neighbours_[i].a, neighbours_[i].b, i);
}

void PairSystem::cut_into_tasks() {
  const auto pieces = [](std::size_t size, int of) { return (static_cast<int>(size) + of - 1) / of; };
  const int tasks = pieces(buckets_.size(), buckets_in_a_task),
            share = std::max(1, pieces(surroundings_.size(), std::max(1, tasks)));
  tasks_.resize(static_cast<std::size_t>(tasks));
  for (int task = 0; task < tasks; ++task) {
    tasks_[task].first = task * buckets_in_a_task;
    tasks_[task].last = std::min(static_cast<int>(buckets_.size()), (task + 1) * buckets_in_a_task);
    tasks_[task].first_surroundings = std::min(static_cast<int>(surroundings_.size()), task * share);
    tasks_[task].last_surroundings = std::min(static_cast<int>(surroundings_.size()), (task + 1) * share);
  }
}

}  // namespace pliant
