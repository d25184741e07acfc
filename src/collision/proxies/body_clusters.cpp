#include "collision/proxies/body_clusters.h"

#include <algorithm>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr std::size_t vertices_in_a_cluster = 64;

/// Splits the vertices [from, to) across their longest extent, recursively, until each part fits a cluster.
void split(const std::vector<Record>& positions, std::vector<int>& vertices, std::size_t from, std::size_t to,
           Clusters& out) {
  const auto place = [&](int v, int axis) {
    return axis == 0 ? positions[v].x : axis == 1 ? positions[v].y : positions[v].z;
  };
  int longest = 0;
  float extent = -1;
  for (int axis = 0; axis < 3; ++axis) {
    float low = place(vertices[from], axis), high = low;
    for (std::size_t i = from; i < to; ++i) {
      low = min(low, place(vertices[i], axis));
      high = max(high, place(vertices[i], axis));
    }
    if (high - low > extent) {
      extent = high - low;
      longest = axis;
    }
  }
  const std::size_t pieces = (to - from + vertices_in_a_cluster - 1) / vertices_in_a_cluster;
  if (pieces == 1) {
    for (std::size_t i = from; i < to; ++i) out.of[vertices[i]] = out.count;
    out.extent.push_back(extent);
    ++out.count;
    return;
  }
  const std::size_t middle = from + (to - from) * (pieces / 2) / pieces;
  const auto at = [&](std::size_t i) { return vertices.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(from), at(middle), at(to), [&](int a, int b) {
    return std::make_pair(place(a, longest), a) < std::make_pair(place(b, longest), b);
  });
  split(positions, vertices, from, middle, out);
  split(positions, vertices, middle, to, out);
}

}  // namespace

Clusters find_clusters(const ContactElements& elements, const std::vector<Record>& positions) {
  Clusters out;
  out.of.assign(positions.size(), -1);
  std::vector<int> vertices = elements.vertices;
  if (!vertices.empty()) split(positions, vertices, 0, vertices.size(), out);
  return out;
}

}  // namespace pliant
