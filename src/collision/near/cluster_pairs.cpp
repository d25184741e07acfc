#include "collision/near/cluster_pairs.h"

#include <algorithm>
#include <tuple>

namespace pliant {

namespace {

/// How far clusters may travel between rebuilds, over the radius: trades near lists against searches.
constexpr float travel_over_radius = 2;

bool is_before(const ClusterPair& x, const ClusterPair& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); }

}  // namespace

/// Measured in the frame midway between both, which moves with the mean of their rigid motions.
void ClusterPair::measure(const ClusterMotions& motions) {
  const ClusterMotion &p = motions[a], &q = motions[b];
  rigid = 0;
  if (a != b) {
    const Vec3f moves = p.mean - q.mean, turns = (p.spin + q.spin) * 0.5f, arm = p.centre - q.centre;
    const float rounded = 1e-6f * (length(moves) + length(turns) * length(arm));
    rigid = (length(moves - cross(turns, arm)) + 0.5f * length(p.spin - q.spin) * (p.radius + q.radius)) * bound_slack +
            rounded;
  }
  odometer.next = p.largest + q.largest + rigid;
}

float ClusterPairs::travel() const { return travel_over_radius * model_.radius; }

void ClusterPairs::find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups) {
  for (int c = 0; c < model_.clusters; ++c)
    boxes_[static_cast<std::size_t>(c)] = motions.path_box(c).grown((0.5f + travel_over_radius) * model_.radius);
  tree_.build(boxes_);
  pairs_.clear();
  const auto add = [&](int a, int b) {
    if (model_.rules.meet(model_.cluster_body[a], model_.cluster_body[b]))
      pairs_.push_back({std::min(a, b), std::max(a, b)});
  };
  for (int c = 0; c < model_.clusters; ++c) add(c, c);
  tree_.self_pairs(add);
  for (const StaticGroup& group : groups) add(group.first, group.second);
  std::sort(pairs_.begin(), pairs_.end(), is_before);
  const auto same = [](const ClusterPair& x, const ClusterPair& y) { return x.a == y.a && x.b == y.b; };
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end(), same), pairs_.end());
  for (const StaticGroup& group : groups)
    pairs_[static_cast<std::size_t>(number_of(group.first, group.second))].is_joined = true;
  for (ClusterPair& pair : pairs_)
    pair.material = model_.rules.material(model_.cluster_body[pair.a], model_.cluster_body[pair.b]);
  measure(motions);
}

void ClusterPairs::measure(const ClusterMotions& motions) {
  for (ClusterPair& pair : pairs_) pair.measure(motions);
}

void ClusterPairs::advance() {
  for (ClusterPair& pair : pairs_) pair.odometer.advance();
}

int ClusterPairs::number_of(int a, int b) const {
  const ClusterPair wanted{std::min(a, b), std::max(a, b)};
  return static_cast<int>(std::lower_bound(pairs_.begin(), pairs_.end(), wanted, is_before) - pairs_.begin());
}

}  // namespace pliant
