#include "collision/proxies/contact_elements.h"

#include <algorithm>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

void require(int vertex, int vertex_count, const char* what, std::size_t number) {
  if (vertex < 0 || vertex >= vertex_count)
    throw Error(Location{.element = std::string(what) + " " + std::to_string(number)},
                "vertex " + std::to_string(vertex) + " does not exist",
                "there are " + std::to_string(vertex_count) + " vertices");
}

template <class T>
void sort_out(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count) {
  for (std::size_t i = 0; i < loose_edges.size(); ++i)
    for (const int vertex : loose_edges[i]) require(vertex, vertex_count, "edge", i);
  for (std::size_t i = 0; i < loose_vertices.size(); ++i) require(loose_vertices[i], vertex_count, "loose vertex", i);
  ContactElements all;
  all.triangles = triangles;
  all.vertices = loose_vertices;
  all.vertex_count = vertex_count;
  for (const Edge& edge : find_edges(triangles, vertex_count)) all.edges.push_back({edge.a, edge.b});
  for (const auto& [a, b] : loose_edges)
    if (a != b) all.edges.push_back({std::min(a, b), std::max(a, b)});
  sort_out(all.edges);
  for (const Triangle& t : triangles) all.vertices.insert(all.vertices.end(), t.begin(), t.end());
  for (const auto& edge : loose_edges) all.vertices.insert(all.vertices.end(), edge.begin(), edge.end());
  sort_out(all.vertices);
  return all;
}

}  // namespace pliant
