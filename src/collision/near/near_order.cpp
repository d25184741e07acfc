#include "collision/near/near_order.h"

#include <algorithm>
#include <tuple>

namespace pliant {

bool is_before(const PairModel& model, const ClusterSides& list, const ClusterSides& other) {
  if (list.of_vertices != other.of_vertices) return list.of_vertices;
  if (list.first != other.first) return model.is_before(list.first, other.first);
  return model.is_before(list.second, other.second);
}

std::vector<ClusterSides> sides_of(const Neighbourhood& near, const std::vector<int>& pairs) {
  std::vector<ClusterSides> all;
  const auto add = [&](bool of_vertices, int first, int second, int pair) {
    if (near.layout.elements[row_kind(of_vertices)].count[first] == 0 ||
        near.layout.elements[column_kind(of_vertices)].count[second] == 0)
      return;
    ClusterSides sides;
    sides.first = first;
    sides.second = second;
    sides.of_vertices = of_vertices;
    sides.pair = pair;
    all.push_back(sides);
  };
  for (const int number : pairs) {
    const int a = near.pairs[number].a, b = near.pairs[number].b;
    add(true, a, b, number);
    if (a != b) add(true, b, a, number);
    add(false, a, b, number);
  }
  std::sort(all.begin(), all.end(),
            [&](const ClusterSides& x, const ClusterSides& y) { return is_before(near.model, x, y); });
  return all;
}

}  // namespace pliant
