#include "collision/narrow/shape_elements.h"

#include <algorithm>

#include "geometry/triangle.h"

namespace pliant {

namespace {

/// Objects that stretch by up to 5 % need no contacts of edges and triangles if vertex contacts suffice at this
/// stretch.
constexpr float stretched = 1.05f;
constexpr std::size_t vertices_in_a_cluster = 32;

std::vector<std::array<int, 2>> edges_of(const CompiledObject& object) {
  std::vector<std::array<int, 2>> edges;
  if (object.surface.triangles.empty()) {
    for (const auto& [a, b] : object.lines)
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }
  for (const Edge& edge : find_edges(object.surface.triangles, object.particles)) edges.push_back({edge.a, edge.b});
  return edges;
}

/// The radius of the smallest circle that encloses a triangle.
float circle_around(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  float side[3] = {length(b - a), length(c - b), length(a - c)};
  std::sort(side, side + 3);
  const bool acute = side[0] * side[0] + side[1] * side[1] > side[2] * side[2];
  const float area = triangle_area(a, b, c);
  return acute && area > 0 ? min(side[0] * side[1] * side[2] / (4 * area), side[2]) : 0.5f * side[2];
}

int tile_of(const CompiledObject& object, int particle) {
  const auto after = std::upper_bound(object.tiles.begin(), object.tiles.end(), particle,
                                      [](int p, const Tile& tile) { return p < tile.first_particle; });
  return static_cast<int>(after - object.tiles.begin()) - 1;
}

Vec3f place_of(const CompiledObject& object, int particle) {
  const Record& r = object.positions[static_cast<std::size_t>(particle)];
  return {r.x, r.y, r.z};
}

float along(const Vec3f& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Returns the axis along which the vertices have their largest extent.
int longest_axis(const CompiledObject& object, const std::vector<int>& vertices) {
  Vec3f low = place_of(object, vertices[0]), high = low;
  for (const int v : vertices) {
    low = min(low, place_of(object, v));
    high = max(high, place_of(object, v));
  }
  const Vec3f size = high - low;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Bisects a set of vertices until each part fits a cluster. Writes each vertex's cluster to `cluster_of`, indexed by
/// vertex.
void split(const CompiledObject& object, std::vector<int> vertices, int& clusters, std::vector<int>& cluster_of) {
  if (vertices.size() <= vertices_in_a_cluster) {
    for (const int v : vertices) cluster_of[static_cast<std::size_t>(v)] = clusters;
    ++clusters;
    return;
  }
  const int axis = longest_axis(object, vertices);
  const auto middle = vertices.begin() + static_cast<std::ptrdiff_t>(vertices.size() / 2);
  std::nth_element(vertices.begin(), middle, vertices.end(), [&](int a, int b) {
    return std::make_pair(along(place_of(object, a), axis), a) < std::make_pair(along(place_of(object, b), axis), b);
  });
  split(object, {vertices.begin(), middle}, clusters, cluster_of);
  split(object, {middle, vertices.end()}, clusters, cluster_of);
}

/// Edges and triangles by their lowest vertex, in the object's indices.
struct ElementLists {
  std::vector<std::array<int, 2>> edges;
  std::vector<Triangle> triangles;
};

void sort_out(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

ElementCluster make_cluster(const ElementLists& lists) {
  ElementCluster out;
  for (const auto& edge : lists.edges) out.vertices.insert(out.vertices.end(), edge.begin(), edge.end());
  for (const auto& triangle : lists.triangles)
    out.vertices.insert(out.vertices.end(), triangle.begin(), triangle.end());
  sort_out(out.vertices);
  const auto place = [&](int vertex) {
    return static_cast<int>(std::lower_bound(out.vertices.begin(), out.vertices.end(), vertex) - out.vertices.begin());
  };
  for (const auto& [a, b] : lists.edges) out.edges.push_back({place(a), place(b)});
  for (const auto& [a, b, c] : lists.triangles) out.triangles.push_back({place(a), place(b), place(c)});
  return out;
}

/// Makes the clusters of a tile; `cluster_of` is scratch memory with an entry for each particle of the object.
TileElements make_tile(const CompiledObject& object, int number, const ElementLists& lists,
                       std::vector<int>& cluster_of) {
  std::vector<int> lowest;
  for (const auto& edge : lists.edges) lowest.push_back(edge[0]);
  for (const auto& t : lists.triangles) lowest.push_back(*std::min_element(t.begin(), t.end()));
  sort_out(lowest);
  TileElements tile;
  if (lowest.empty()) return tile;
  int clusters = 0;
  split(object, lowest, clusters, cluster_of);
  std::vector<ElementLists> of_cluster(static_cast<std::size_t>(clusters));
  const auto cluster = [&](int vertex) -> ElementLists& {
    return of_cluster[static_cast<std::size_t>(cluster_of[static_cast<std::size_t>(vertex)])];
  };
  for (const auto& edge : lists.edges) cluster(edge[0]).edges.push_back(edge);
  for (const auto& t : lists.triangles) cluster(*std::min_element(t.begin(), t.end())).triangles.push_back(t);
  for (const ElementLists& of : of_cluster) {
    tile.clusters.push_back(make_cluster(of));
    for (const int v : tile.clusters.back().vertices)
      if (const int other = tile_of(object, v); other != number) tile.neighbours.push_back(other);
  }
  sort_out(tile.neighbours);
  return tile;
}

}  // namespace

ShapeElements make_shape_elements(const CompiledObject& object) {
  ShapeElements all;
  std::vector<ElementLists> of_tile(object.tiles.size());
  for (const auto& edge : edges_of(object)) {
    all.radius = max(all.radius, 0.5f * length(place_of(object, edge[1]) - place_of(object, edge[0])));
    of_tile[static_cast<std::size_t>(tile_of(object, edge[0]))].edges.push_back(edge);
  }
  for (const auto& t : object.surface.triangles) {
    all.radius = max(all.radius, circle_around(place_of(object, t[0]), place_of(object, t[1]), place_of(object, t[2])));
    of_tile[static_cast<std::size_t>(tile_of(object, *std::min_element(t.begin(), t.end())))].triangles.push_back(t);
  }
  std::vector<int> cluster_of(static_cast<std::size_t>(object.particles));
  for (std::size_t i = 0; i < of_tile.size(); ++i)
    all.tiles.push_back(make_tile(object, static_cast<int>(i), of_tile[i], cluster_of));
  return all;
}

bool may_dip(float radius, const LocalShape& shape, float thickness) {
  if (shape.kind == ShapeKind::plane || !(radius > 0)) return false;
  if (shape.kind == ShapeKind::box) return true;
  const float grown = shape.a + thickness, wide = stretched * radius;
  return wide >= grown || grown - sqrt(grown * grown - wide * wide) > least_dip(wide, thickness);
}

}  // namespace pliant
