// Edges by a counting sort: half-edges go into one bucket for each smaller end, and
// each bucket is sorted by the larger end. A vertex has about six edges, so the time
// is linear, unlike a comparison sort of all edges. Memory is accessed in order.
#include "topology/edges.h"

#include <algorithm>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

/// A side of a triangle. It is stored in the bucket of its smaller vertex.
struct HalfEdge {
  int larger;
  std::uint32_t side;  ///< 3 x triangle + number of the corner at which the side starts
};

bool before(const HalfEdge& left, const HalfEdge& right) {
  return left.larger != right.larger ? left.larger < right.larger : left.side < right.side;
}

struct Side {
  int from, to, opposite;
};

Side side_of(const Triangle& triangle, std::size_t corner) {
  return {triangle[corner], triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]};
}

/// Half-edges sorted by bucket; those of vertex v have the indices starts[v] to starts[v + 1] - 1.
struct Buckets {
  std::vector<std::size_t> starts;
  std::vector<HalfEdge> half_edges;
};

Buckets deal(const std::vector<Triangle>& triangles, int vertex_count) {
  Buckets buckets;
  buckets.starts.assign(static_cast<std::size_t>(vertex_count) + 2, 0);
  // Counts are stored one entry further, so that filling the buckets advances each start to the next one.
  for (const Triangle& triangle : triangles)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Side side = side_of(triangle, corner);
      if (side.from != side.to) ++buckets.starts[static_cast<std::size_t>(std::min(side.from, side.to)) + 2];
    }
  for (std::size_t v = 2; v < buckets.starts.size(); ++v) buckets.starts[v] += buckets.starts[v - 1];
  buckets.half_edges.resize(buckets.starts.back());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Side side = side_of(triangles[t], corner);
      if (side.from == side.to) continue;
      const std::size_t place = buckets.starts[static_cast<std::size_t>(std::min(side.from, side.to)) + 1]++;
      buckets.half_edges[place] = {std::max(side.from, side.to), static_cast<std::uint32_t>(3 * t + corner)};
    }
  return buckets;
}

void add_triangle(Edge& edge, const std::vector<Triangle>& triangles, std::uint32_t half_edge) {
  const auto count = static_cast<std::size_t>(edge.triangle_count++);
  if (count >= 2) return;
  const Side side = side_of(triangles[half_edge / 3], half_edge % 3);
  edge.triangles[count] = static_cast<int>(half_edge / 3);
  edge.opposites[count] = side.opposite;
  edge.forward[count] = side.from == edge.a;
}

}  // namespace

void require_indices(const std::vector<Triangle>& triangles, int vertex_count) {
  if (triangles.size() > 0x55555555u)
    throw Error({}, std::to_string(triangles.size()) + " triangles exceed the limit", "split the mesh");
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int vertex : triangles[t])
      if (vertex < 0 || vertex >= vertex_count)
        throw Error(
            {"", 0, "", "triangle " + std::to_string(t)},
            "uses vertex " + std::to_string(vertex) + ", but there are " + std::to_string(vertex_count) + " vertices",
            "indices count from 0");
}

std::vector<Edge> find_edges(const std::vector<Triangle>& triangles, int vertex_count) {
  require_indices(triangles, vertex_count);
  Buckets buckets = deal(triangles, vertex_count);
  std::vector<Edge> edges;
  edges.reserve(triangles.size() + triangles.size() / 2 + 16);
  for (int v = 0; v < vertex_count; ++v) {
    const auto first =
        buckets.half_edges.begin() + static_cast<std::ptrdiff_t>(buckets.starts[static_cast<std::size_t>(v)]);
    const auto last =
        buckets.half_edges.begin() + static_cast<std::ptrdiff_t>(buckets.starts[static_cast<std::size_t>(v) + 1]);
    std::sort(first, last, before);
    for (auto half = first; half != last; ++half) {
      if (half == first || half->larger != (half - 1)->larger) {
        edges.emplace_back();
        edges.back().a = v;
        edges.back().b = half->larger;
      }
      add_triangle(edges.back(), triangles, half->side);
    }
  }
  return edges;
}

Hinge hinge_of(const Edge& edge) {
  // If both triangles traverse the edge in the same direction, that of the first one counts as forward.
  const std::size_t front = edge.forward[0] || !edge.forward[1] ? 0 : 1;
  const std::size_t back = 1 - front;
  if (edge.forward[front]) return {edge.a, edge.b, edge.opposites[front], edge.opposites[back]};
  return {edge.b, edge.a, edge.opposites[front], edge.opposites[back]};
}

std::vector<Hinge> find_hinges(const std::vector<Edge>& edges) {
  std::vector<Hinge> hinges;
  hinges.reserve(edges.size());
  for (const Edge& edge : edges)
    if (edge.is_inner()) hinges.push_back(hinge_of(edge));
  return hinges;
}

}  // namespace pliant
