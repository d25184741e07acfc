#include "collision/near/near_order.h"

namespace pliant {

bool is_before(const PairModel& model, const ClusterSides& list, const ClusterSides& other) {
  if (list.of_vertices != other.of_vertices) return list.of_vertices;
  if (list.first != other.first) return model.is_before(list.first, other.first);
  return model.is_before(list.second, other.second);
}

std::vector<ClusterSides> sides_of(const Neighbourhood& near, const std::vector<int>& pairs) {
  std::vector<ClusterSides> sides;
  sides.reserve(3 * pairs.size());
  const auto add = [&](bool of_vertices, int first, int second, int pair) {
    if (near.layout.elements[row_kind(of_vertices)].count[first] > 0 &&
        near.layout.elements[column_kind(of_vertices)].count[second] > 0)
      sides.push_back({first, second, of_vertices, pair});
  };
  const PairsOfClusters of_clusters = near.pairs.by_cluster(pairs);
  const std::vector<int>& order = near.model.cluster_order;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (int k = of_clusters.start[i]; k < of_clusters.start[i + 1]; ++k)
      add(true, order[i], order[of_clusters.entries[k].other], of_clusters.entries[k].pair);
  for (const int number : pairs) add(false, near.pairs[number].a, near.pairs[number].b, number);
  return sides;
}

}  // namespace pliant
