#include "collision/near/cluster_pairs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace pliant {

namespace {

/// How far clusters may travel between broad-phase rebuilds, over the search radius. More means longer lists, fewer
/// rebuilds.
constexpr float travel_over_radius = 2;

/// Two positions in an order of clusters.
using Places = std::array<int, 2>;

/// Sorts pairs of places below `places`, and drops duplicates. Two stable counting sorts are faster than a comparison
/// sort.
void sort_unique(std::vector<Places>& pairs, std::size_t places) {
  std::vector<Places> sorted(pairs.size());
  std::vector<int> next;
  for (const std::size_t side : {1, 0}) {
    next.assign(places + 1, 0);
    for (const Places& pair : pairs) ++next[static_cast<std::size_t>(pair[side]) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Places& pair : pairs)
      sorted[static_cast<std::size_t>(next[static_cast<std::size_t>(pair[side])]++)] = pair;
    pairs.swap(sorted);
  }
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace

/// Motion is measured relative to the mean of the two clusters' rigid motions.
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

void ClusterPairs::add_if_they_meet(int a, int b, std::vector<Clusters>& to) const {
  if (!model_.shared->rules.meet(model_.cluster_body[a], model_.cluster_body[b])) return;
  to.push_back(rank_[b] < rank_[a] ? Clusters{b, a} : Clusters{a, b});
}

void ClusterPairs::sort(std::vector<Clusters>& pairs) const {
  std::sort(pairs.begin(), pairs.end(), [&](const Clusters& x, const Clusters& y) { return key_of(x) < key_of(y); });
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

ClusterPair ClusterPairs::make(const Clusters& clusters) const {
  ClusterPair pair{clusters.first, clusters.second};
  pair.material = model_.shared->rules.material(model_.cluster_body[pair.a], model_.cluster_body[pair.b]);
  return pair;
}

void ClusterPairs::fit_boxes(const ClusterMotions& motions) {
  boxes_.clear();
  rank_.resize(model_.cluster_body.size());
  for (const int c : model_.cluster_order) {
    rank_[c] = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back(motions.path_box(c).grown((0.5f + travel_over_radius) * model_.radius));
  }
}

std::vector<int> ClusterPairs::find(const ClusterMotions& motions, const std::vector<StaticGroup>& groups) {
  const std::vector<int>& order = model_.cluster_order;
  fit_boxes(motions);
  tree_.build(boxes_);
  std::vector<Places> found;
  const auto add = [&](int i, int k) {
    if (model_.shared->rules.meet(model_.cluster_body[order[i]], model_.cluster_body[order[k]]))
      found.push_back({std::min(i, k), std::max(i, k)});
  };
  for (int i = 0; i < static_cast<int>(order.size()); ++i) add(i, i);
  tree_.self_pairs(add);
  for (const StaticGroup& group : groups)
    add(static_cast<int>(rank_[group.first]), static_cast<int>(rank_[group.second]));
  sort_unique(found, order.size());
  pairs_.clear();
  for (const auto& [a, b] : found) pairs_.push_back(make({order[a], order[b]}));
  std::vector<int> of_groups = numbers_of(groups);
  for (const int number : of_groups) pairs_[static_cast<std::size_t>(number)].is_joined = true;
  measure(motions);
  return of_groups;
}

std::vector<int> ClusterPairs::find_of_new(const std::vector<int>& clusters, const ClusterMotions& motions,
                                           const std::vector<StaticGroup>& groups) {
  const std::vector<int>& order = model_.cluster_order;
  fit_boxes(motions);
  std::vector<Clusters> found;
  for (const int c : clusters) {
    const BoxBounds box = motions.path_box(c).grown((0.5f + travel_over_radius) * model_.radius);
    for (std::size_t i = 0; i < order.size(); ++i)
      if (order[i] == c || overlap(box, boxes_[i])) add_if_they_meet(c, order[i], found);
  }
  for (const StaticGroup& group : groups)
    if (group.pair < 0) add_if_they_meet(group.first, group.second, found);
  sort(found);
  std::vector<int> added;
  std::size_t slot = 0;
  for (const Clusters& of : found) {
    while (slot < pairs_.size() && pairs_[slot].a >= 0) ++slot;
    if (slot == pairs_.size()) pairs_.emplace_back();
    pairs_[slot] = make(of);
    pairs_[slot].measure(motions);
    added.push_back(static_cast<int>(slot));
  }
  for (const StaticGroup& group : groups)
    if (group.pair < 0) pairs_[static_cast<std::size_t>(number_of(group, added))].is_joined = true;
  return added;
}

void ClusterPairs::remove(const std::vector<char>& is_removed) {
  for (ClusterPair& pair : pairs_)
    if (pair.a >= 0 && (is_removed[pair.a] != 0 || is_removed[pair.b] != 0)) pair = {-1, -1};
}

void ClusterPairs::measure(const ClusterMotions& motions) {
  for (ClusterPair& pair : pairs_)
    if (pair.a >= 0) pair.measure(motions);
}

void ClusterPairs::advance() {
  for (ClusterPair& pair : pairs_) pair.odometer.advance();
}

std::vector<int> ClusterPairs::numbers() const {
  std::vector<int> all(pairs_.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

PairsOfClusters ClusterPairs::by_cluster(const std::vector<int>& among) const {
  PairsOfClusters out;
  const auto for_each = [&](auto visit) {
    for (const int number : among) {
      const ClusterPair& pair = pairs_[static_cast<std::size_t>(number)];
      const int a = static_cast<int>(rank_[pair.a]), b = static_cast<int>(rank_[pair.b]);
      visit(a, b, number);
      if (a != b) visit(b, a, number);
    }
  };
  // next[c + 1]: the next entry of cluster c. Pairs are visited in sorted order, which sorts each cluster's entries.
  std::vector<int> next(boxes_.size() + 2, 0);
  for_each([&](int of, int, int) { ++next[static_cast<std::size_t>(of) + 2]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  out.entries.resize(static_cast<std::size_t>(next.back()));
  for_each([&](int of, int other, int number) {
    out.entries[static_cast<std::size_t>(next[static_cast<std::size_t>(of) + 1]++)] = {other, number};
  });
  out.start = std::move(next);
  return out;
}

/// The index of each group's pair after find(). Groups of one kind come in the order of the entries, so each search
/// continues where the previous one ended.
std::vector<int> ClusterPairs::numbers_of(const std::vector<StaticGroup>& groups) const {
  const PairsOfClusters pairs = by_cluster(numbers());
  std::vector<int> out;
  out.reserve(groups.size());
  int first = -1;
  const PairsOfClusters::Entry* at = nullptr;
  for (const StaticGroup& group : groups) {
    const int second = static_cast<int>(rank_[group.second]);
    if (group.first != first || second < at->other)
      at = &pairs.entries[static_cast<std::size_t>(pairs.start[rank_[group.first]])];
    first = group.first;
    while (at->other != second) ++at;  // finds it: the list has the pairs of all static groups
    out.push_back(at->pair);
  }
  return out;
}

int ClusterPairs::number_of(const StaticGroup& group, const std::vector<int>& among) const {
  const auto [a, b] = std::minmax(group.first, group.second);  // within one body clusters are ordered by index
  const auto before = [&](int number, std::uint64_t wanted) {
    return key_of({pairs_[number].a, pairs_[number].b}) < wanted;
  };
  return *std::lower_bound(among.begin(), among.end(), key_of({a, b}), before);
}

}  // namespace pliant
