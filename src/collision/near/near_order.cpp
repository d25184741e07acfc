#include "collision/near/near_order.h"

#include <algorithm>
#include <cstdint>

namespace pliant {

bool is_before(const PairModel& model, const ClusterSides& list, const ClusterSides& other) {
  if (list.of_vertices != other.of_vertices) return list.of_vertices;
  if (list.first != other.first) return model.is_before(list.first, other.first);
  return model.is_before(list.second, other.second);
}

std::vector<ClusterSides> sides_of(const Neighbourhood& near, const std::vector<int>& pairs) {
  std::vector<std::uint64_t> place(near.model.cluster_body.size());
  for (std::size_t i = 0; i < near.model.cluster_order.size(); ++i) place[near.model.cluster_order[i]] = i;
  struct Keyed {
    std::uint64_t key;  // sorts as is_before does
    ClusterSides sides;
  };
  std::vector<Keyed> all;
  all.reserve(3 * pairs.size());
  const auto add = [&](bool of_vertices, int first, int second, int pair) {
    if (near.layout.elements[row_kind(of_vertices)].count[first] == 0 ||
        near.layout.elements[column_kind(of_vertices)].count[second] == 0)
      return;
    const std::uint64_t kind = of_vertices ? 0 : 1;
    all.push_back({kind << 63 | place[first] << 32 | place[second], {first, second, of_vertices, pair}});
  };
  for (const int number : pairs) {
    const int a = near.pairs[number].a, b = near.pairs[number].b;
    add(true, a, b, number);
    if (a != b) add(true, b, a, number);
    add(false, a, b, number);
  }
  std::sort(all.begin(), all.end(), [](const Keyed& x, const Keyed& y) { return x.key < y.key; });
  std::vector<ClusterSides> sides;
  sides.reserve(all.size());
  for (const Keyed& one : all) sides.push_back(one.sides);
  return sides;
}

}  // namespace pliant
