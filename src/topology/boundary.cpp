// Follows edges: along borders from vertex to vertex, within components from triangle to triangle.
#include "topology/boundary.h"

#include <algorithm>
#include <utility>

#include "topology/incidence.h"

namespace pliant {

namespace {

/// Follows borders. When the path returns to one of its vertices, the loop between both visits is removed from it and
/// stored.
class BorderWalk {
 public:
  BorderWalk(const std::vector<Edge>& edges, int vertex_count)
      : edges_(edges),
        at_vertex_(incidence(edges, vertex_count,
                             [](const Edge& e) {
                               return e.is_border() ? std::array{e.a, e.b} : std::array{-1, -1};
                             })),
        next_(at_vertex_.starts.begin(), at_vertex_.starts.end() - 1),
        used_(edges.size(), false),
        place_(static_cast<std::size_t>(vertex_count), -1) {}

  void walk_from(int vertex) {
    push(vertex);
    for (int edge = unused_edge(path_.back()); edge >= 0; edge = unused_edge(path_.back())) {
      used_[static_cast<std::size_t>(edge)] = true;
      const Edge& e = edges_[static_cast<std::size_t>(edge)];
      const int to = e.a == path_.back() ? e.b : e.a;
      if (place_[static_cast<std::size_t>(to)] < 0)
        push(to);
      else
        take_loop(to);
    }
    if (path_.size() > 1) loops_.push_back(path_);
    for (int left : path_) place_[static_cast<std::size_t>(left)] = -1;
    path_.clear();
  }

  bool used(std::size_t edge) const { return used_[edge]; }
  std::vector<std::vector<int>> take() { return std::move(loops_); }

 private:
  void push(int vertex) {
    place_[static_cast<std::size_t>(vertex)] = static_cast<int>(path_.size());
    path_.push_back(vertex);
  }

  void take_loop(int vertex) {
    const auto first = path_.begin() + place_[static_cast<std::size_t>(vertex)];
    loops_.emplace_back(first, path_.end());
    for (auto left = first + 1; left != path_.end(); ++left) place_[static_cast<std::size_t>(*left)] = -1;
    path_.erase(first + 1, path_.end());
  }

  int unused_edge(int vertex) {
    std::size_t& next = next_[static_cast<std::size_t>(vertex)];
    const std::size_t end = at_vertex_.starts[static_cast<std::size_t>(vertex) + 1];
    while (next < end && used_[static_cast<std::size_t>(at_vertex_.edges[next])]) ++next;
    return next < end ? at_vertex_.edges[next] : -1;
  }

  const std::vector<Edge>& edges_;
  Incidence at_vertex_;
  std::vector<std::size_t> next_;  ///< position at which to resume in each vertex's list; each edge is visited once
  std::vector<bool> used_;
  std::vector<int> place_;  ///< index of each vertex on the path, or -1
  std::vector<int> path_;
  std::vector<std::vector<int>> loops_;
};

/// A flood fill that finds the winding of each triangle relative to the first triangle of its connected component.
class Flood {
 public:
  Flood(const std::vector<Edge>& edges, int triangle_count)
      : edges_(edges),
        at_triangle_(incidence(edges, triangle_count,
                               [](const Edge& e) {
                                 return e.is_inner() ? e.triangles : std::array{-1, -1};
                               })),
        turned_(static_cast<std::size_t>(triangle_count), 0) {
    pieces_.of_triangle.assign(static_cast<std::size_t>(triangle_count), -1);
  }

  void fill_from(int first) {
    members_.assign(1, first);
    pieces_.of_triangle[static_cast<std::size_t>(first)] = pieces_.count;
    int conflict = -1;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const auto triangle = static_cast<std::size_t>(members_[m]);
      for (std::size_t i = at_triangle_.starts[triangle]; i < at_triangle_.starts[triangle + 1]; ++i)
        if (!cross(members_[m], at_triangle_.edges[i]) && conflict < 0) conflict = at_triangle_.edges[i];
    }
    if (conflict >= 0)
      pieces_.one_sided_edges.push_back(conflict);
    else
      keep_fewer();
    ++pieces_.count;
  }

  bool seen(int triangle) const { return pieces_.of_triangle[static_cast<std::size_t>(triangle)] >= 0; }

  Pieces take() {
    std::sort(pieces_.flipped.begin(), pieces_.flipped.end());
    return std::move(pieces_);
  }

 private:
  /// Visits the triangle on the other side of an edge. Returns false if it was reached before with the opposite
  /// winding.
  bool cross(int triangle, int edge_index) {
    const Edge& edge = edges_[static_cast<std::size_t>(edge_index)];
    const int other = edge.triangles[0] == triangle ? edge.triangles[1] : edge.triangles[0];
    const auto turn =
        static_cast<char>(turned_[static_cast<std::size_t>(triangle)] ^ (edge.is_wound_consistently() ? 0 : 1));
    if (seen(other)) return turned_[static_cast<std::size_t>(other)] == turn;
    turned_[static_cast<std::size_t>(other)] = turn;
    pieces_.of_triangle[static_cast<std::size_t>(other)] = pieces_.count;
    members_.push_back(other);
    return true;
  }

  void keep_fewer() {
    const auto turned = [this](int t) { return turned_[static_cast<std::size_t>(t)] != 0; };
    const auto count = static_cast<std::size_t>(std::count_if(members_.begin(), members_.end(), turned));
    const bool wanted = 2 * count <= members_.size();
    for (int t : members_)
      if (turned(t) == wanted) pieces_.flipped.push_back(t);
  }

  const std::vector<Edge>& edges_;
  Incidence at_triangle_;
  std::vector<char> turned_;
  std::vector<int> members_;
  Pieces pieces_;
};

}  // namespace

bool is_closed(const std::vector<Edge>& edges) {
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [](const Edge& e) { return e.is_inner(); });
}

bool is_edge_manifold(const std::vector<Edge>& edges) {
  return std::all_of(edges.begin(), edges.end(), [](const Edge& e) { return e.triangle_count <= 2; });
}

bool is_wound_consistently(const std::vector<Edge>& edges) {
  return std::all_of(edges.begin(), edges.end(), [](const Edge& e) { return e.is_wound_consistently(); });
}

std::vector<std::vector<int>> boundary_loops(const std::vector<Edge>& edges, int vertex_count) {
  BorderWalk walk(edges, vertex_count);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges[e].is_border() && !walk.used(e)) walk.walk_from(edges[e].a);
  return walk.take();
}

Pieces find_pieces(const std::vector<Edge>& edges, int triangle_count) {
  Flood flood(edges, triangle_count);
  for (int t = 0; t < triangle_count; ++t)
    if (!flood.seen(t)) flood.fill_from(t);
  return flood.take();
}

void flip(std::vector<Triangle>& triangles, const std::vector<int>& which) {
  for (int t : which) std::swap(triangles[static_cast<std::size_t>(t)][1], triangles[static_cast<std::size_t>(t)][2]);
}

}  // namespace pliant
