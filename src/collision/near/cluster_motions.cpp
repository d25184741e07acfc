#include "collision/near/cluster_motions.h"

#include <algorithm>

#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int clusters_in_a_task = 16;
/// Upper bound of the number of roundings of a position in the frame that moves with the mean displacement.
constexpr float place_roundings = 16;

}  // namespace

void ClusterMotions::resize(std::size_t clusters) {
  motions_.resize(clusters);
  travel_.resize(clusters);
  extent_.resize(clusters);
}

void ClusterMotions::reset(int cluster) {
  motions_[static_cast<std::size_t>(cluster)] = {};
  travel_[static_cast<std::size_t>(cluster)] = extent_[static_cast<std::size_t>(cluster)] = 0;
}

bool ClusterMotions::measure(Executor& executor, const ClusterLayout& layout, const std::vector<int>& order,
                             const PairParticles& particles) {
  for_items(executor, "contact bounds", static_cast<int>(motions_.size()), clusters_in_a_task, [&](int c) {
    if (const int count = layout.vertex_count[c]; count > 0)
      kernels_.measure_cluster(layout.vertices.data() + layout.vertex_start[c], count, particles, motions_[c]);
  });
  find_means(order);
  return std::all_of(order.begin(), order.end(),
                     [&](int c) { return motions_[static_cast<std::size_t>(c)].is_bounded; });
}

void ClusterMotions::find_means(const std::vector<int>& order) {
  sums_.assign(static_cast<std::size_t>(model_.sets), {});
  for (const int c : order) {
    const ClusterMotion& motion = motions_[static_cast<std::size_t>(c)];
    Sum& sum = sums_[static_cast<std::size_t>(model_.set_of_cluster(c))];
    sum.of_displacements += convert<double>(motion.sum);
    sum.count += double(motion.movable);
  }
  means_.resize(sums_.size());
  for (std::size_t set = 0; set < sums_.size(); ++set) {
    const Sum& sum = sums_[set];
    means_[set] = sum.count > 0 ? convert<float>(sum.of_displacements * (1. / sum.count)) : Vec3f{};
  }
}

void ClusterMotions::advance(const std::vector<int>& order) {
  for (const int c : order) {
    float& travel = travel_[static_cast<std::size_t>(c)];
    travel = (travel + travel_next(c)) * (1 + 1e-6f);
  }
}

BoxBounds ClusterMotions::path_box(int cluster) const {
  const ClusterMotion& m = motions_[static_cast<std::size_t>(cluster)];
  return {min(m.low[0], m.low[1] - mean(cluster)), max(m.high[0], m.high[1] - mean(cluster))};
}

/// Upper bound of the displacement in this substep of any vertex of the cluster, relative to mean() [m].
float ClusterMotions::travel_next(int cluster) const {
  const ClusterMotion& motion = motions_[static_cast<std::size_t>(cluster)];
  return (length(motion.mean - mean(cluster)) + length(motion.spin) * motion.radius) * bound_slack + motion.largest;
}

bool ClusterMotions::stay_within(float room, const std::vector<int>& order) const {
  return std::all_of(order.begin(), order.end(), [&](int cluster) {
    const auto c = static_cast<std::size_t>(cluster);
    const float rounded = place_roundings * one_rounding * (motions_[c].extent + largest(mean(cluster)));
    return travel_[c] + travel_next(cluster) <= room - rounded;
  });
}

bool ClusterMotions::has_gone_far() const {
  for (std::size_t c = 0; c < motions_.size(); ++c)
    if (!(motions_[c].extent <= 2 * extent_[c])) return true;
  return false;
}

void ClusterMotions::begin_travel() { std::fill(travel_.begin(), travel_.end(), 0.f); }

void ClusterMotions::keep_extents() {
  for (std::size_t c = 0; c < motions_.size(); ++c) extent_[c] = motions_[c].extent;
}

void ClusterMotions::keep_extent(int cluster) {
  extent_[static_cast<std::size_t>(cluster)] = motions_[static_cast<std::size_t>(cluster)].extent;
}

}  // namespace pliant
