// The edges at each vertex, or at each triangle.
#pragma once

#include <cstddef>
#include <vector>

namespace pliant {

/// For each item 0..count - 1 its edges, ascending, in compressed rows: item i has the entries starts[i] to starts[i +
/// 1] - 1.
struct Incidence {
  std::vector<std::size_t> starts;
  std::vector<int> edges;
};

/// Makes an Incidence. `ends(edge)` returns the two items of an edge, or {-1, -1} to leave the edge out.
template <class AnyEdge, class Ends>
Incidence incidence(const std::vector<AnyEdge>& edges, int count, Ends ends) {
  Incidence result;
  result.starts.assign(static_cast<std::size_t>(count) + 2, 0);
  for (const AnyEdge& edge : edges)
    for (int item : ends(edge))
      if (item >= 0) ++result.starts[static_cast<std::size_t>(item) + 2];
  for (std::size_t i = 2; i < result.starts.size(); ++i) result.starts[i] += result.starts[i - 1];
  result.edges.resize(result.starts.back());
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (int item : ends(edges[e]))
      if (item >= 0) result.edges[result.starts[static_cast<std::size_t>(item) + 1]++] = static_cast<int>(e);
  return result;
}

}  // namespace pliant
