// Updates near lists after bodies were added or removed. Only lists of changed bodies are touched.
#include <algorithm>

#include "collision/near/near_lists.h"
#include "collision/near/near_order.h"

namespace pliant {

namespace {

/// All clusters are paired again if more than one in this many is new.
constexpr std::size_t most_new_clusters = 8;

}  // namespace

void NearLists::change(const PairChanges& changes) {
  remove(changes.removed, changes.clusters);
  resize();
  add(changes.added);
  must_pair_ =
      must_pair_ || changes.radius || most_new_clusters * new_clusters_.size() > near_.model.cluster_order.size();
  cut_into_tasks();
}

void NearLists::remove(const std::vector<int>& bodies, const std::vector<Block>& clusters) {
  if (bodies.empty()) return;
  std::vector<char> is_removed(near_.layout.vertex_count.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::fill_n(is_removed.begin() + clusters[i].first, clusters[i].size, 1);
    for (int c = clusters[i].first; c < clusters[i].end(); ++c) near_.motions.reset(c);
    near_.layout.remove(bodies[i], clusters[i]);
    clearance_.clearance().remove(bodies[i]);
  }
  near_.pairs.remove(is_removed);
  near_.static_pairs.remove(is_removed);
  std::erase_if(new_clusters_, [&](int c) { return is_removed[c] != 0; });
  std::erase_if(near_.order, [&](std::int32_t number) {
    NearList& list = near_.lists[number];
    if (is_removed[list.first] == 0 && is_removed[list.second] == 0) return false;
    listed_ -= list.pairs;
    list = {};
    unused_lists_.push_back(number);
    return true;
  });
}

void NearLists::add(const std::vector<int>& bodies) {
  for (const int body : bodies) {
    near_.layout.add(near_.model, body);
    const Block clusters = near_.model.bodies.at(body).clusters;
    for (int c = clusters.first; c < clusters.end(); ++c) new_clusters_.push_back(c);
  }
  add_static_pairs(near_.model, bodies, near_.layout, near_.static_pairs, clearance_.clearance());
  search_.fit_to_layout();
}

void NearLists::resize() {
  near_.motions.resize(near_.model.cluster_body.size());
  clearance_.resize(near_.model.cluster_body.size());
}

/// Pairs the new clusters. Their motion must have been measured.
void NearLists::pair_new_clusters() {
  const std::vector<int> pairs = near_.pairs.find_of_new(new_clusters_, near_.motions, near_.static_pairs.groups);
  for (StaticGroup& group : near_.static_pairs.groups)
    if (group.pair < 0) group.pair = near_.pairs.number_of(group, pairs);
  add_lists(pairs);
  cut_into_tasks();
  new_clusters_.clear();
}

/// Inserts empty near lists for new cluster pairs, in the order of near lists.
void NearLists::add_lists(const std::vector<int>& pairs) {
  const auto before = [&](std::int32_t x, const ClusterSides& y) { return is_before(near_.model, near_.lists[x], y); };
  std::vector<std::int32_t> order;
  auto next = near_.order.begin();
  for (const ClusterSides& sides : sides_of(near_, pairs)) {
    if (unused_lists_.empty()) {
      unused_lists_.push_back(static_cast<std::int32_t>(near_.lists.size()));
      near_.lists.emplace_back();
    }
    const std::int32_t number = unused_lists_.back();
    unused_lists_.pop_back();
    const auto at = std::lower_bound(next, near_.order.end(), sides, before);
    order.insert(order.end(), next, at);
    order.push_back(number);
    next = at;
    near_.lists[number] = {};
    static_cast<ClusterSides&>(near_.lists[number]) = sides;
  }
  order.insert(order.end(), next, near_.order.end());
  near_.order = std::move(order);
}

}  // namespace pliant
