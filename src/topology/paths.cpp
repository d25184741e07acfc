#include "topology/paths.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "topology/incidence.h"

namespace pliant {

namespace {

using EdgeList = std::vector<std::array<int, 2>>;

/// A vertex with more edges is a hub, not part of a surface; no path passes through it.
constexpr std::size_t largest_degree = 64;

/// Number of colours that are chosen greedily. The paths left after that are few and odd, and are coloured in one pass.
constexpr int most_careful_colours = 48;

/// Cosine of the largest angle, 45 degrees, by which a path turns from one edge to the next.
constexpr double least_cosine = 0.70710678118654752;

Vec3d between(const std::vector<Vec3f>& x, int from, int to) {
  return {double(x[to].x) - x[from].x, double(x[to].y) - x[from].y, double(x[to].z) - x[from].z};
}

double cosine(const Vec3d& a, const Vec3d& b) {
  const double lengths = std::sqrt(length_squared(a) * length_squared(b));
  return lengths > 0 ? dot(a, b) / lengths : 0;
}

/// For each edge, the edges that continue it at its two ends, or -1.
using Continuations = std::vector<std::array<int, 2>>;

int other_end(const std::array<int, 2>& edge, int end) { return edge[0] == end ? edge[1] : edge[0]; }
int slot_of(const std::array<int, 2>& edge, int end) { return edge[0] == end ? 0 : 1; }

/// Joins the edges at each vertex into pairs, the straightest pair first.
Continuations join_straightest(const std::vector<Vec3f>& x, const EdgeList& edges) {
  const Incidence at =
      incidence(edges, static_cast<int>(x.size()), [](const std::array<int, 2>& edge) { return edge; });
  Continuations next(edges.size(), {-1, -1});
  std::vector<std::tuple<double, int, int>> pairs;  // negative cosine of the angle, then the two edges
  for (int v = 0; v < static_cast<int>(x.size()); ++v) {
    pairs.clear();
    if (at.starts[v + 1] - at.starts[v] > largest_degree) continue;
    for (std::size_t i = at.starts[v]; i < at.starts[v + 1]; ++i) {
      for (std::size_t j = i + 1; j < at.starts[v + 1]; ++j) {
        const int e = at.edges[i], f = at.edges[j];
        const double straight = cosine(between(x, other_end(edges[e], v), v), between(x, v, other_end(edges[f], v)));
        if (straight >= least_cosine) pairs.emplace_back(-straight, e, f);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [order, e, f] : pairs) {
      int &from_e = next[e][slot_of(edges[e], v)], &from_f = next[f][slot_of(edges[f], v)];
      if (from_e >= 0 || from_f >= 0) continue;
      from_e = f;
      from_f = e;
    }
  }
  return next;
}

/// Follows trails of joined edges, and cuts them where they return to a vertex.
class Walker {
 public:
  Walker(const EdgeList& edges, const Continuations& next, std::size_t vertices)
      : edges_(edges), next_(next), used_(edges.size(), 0), visited_by_(vertices, -1) {}

  std::vector<Path> walk_all() {
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {  // first the open trails, from their ends
      for (int slot = 0; slot < 2; ++slot)
        if (!used_[e] && next_[e][slot] < 0) walk(e, edges_[e][slot]);
    }
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e)  // then the closed trails
      if (!used_[e]) walk(e, edges_[e][0]);
    return std::move(paths_);
  }

 private:
  void begin_at(int vertex) {
    paths_.emplace_back();
    paths_.back().vertices.push_back(vertex);
    visited_by_[vertex] = static_cast<int>(paths_.size());
  }

  void walk(int edge, int from) {
    begin_at(from);
    while (edge >= 0 && !used_[edge]) {
      const int to = other_end(edges_[edge], from);
      if (visited_by_[to] == static_cast<int>(paths_.size())) begin_at(from);
      used_[edge] = 1;
      paths_.back().edges.push_back(edge);
      paths_.back().vertices.push_back(to);
      visited_by_[to] = static_cast<int>(paths_.size());
      edge = next_[edge][slot_of(edges_[edge], to)];
      from = to;
    }
  }

  const EdgeList& edges_;
  const Continuations& next_;
  std::vector<char> used_;
  std::vector<int> visited_by_;  // for each vertex, the number of the last path through it, plus one
  std::vector<Path> paths_;
};

void reverse(Path& path) {
  std::reverse(path.edges.begin(), path.edges.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
}

/// Takes colours greedily from a set of paths. Each colour starts with the longest path left. Paths that share no
/// vertex with the colour are added to it, the most nearly parallel first.
class PathColouring {
 public:
  PathColouring(const std::vector<Vec3f>& x, std::vector<Path> paths)
      : paths_(std::move(paths)), taken_by_(x.size(), 0) {
    for (const Path& path : paths_) along_.push_back(between(x, path.vertices.front(), path.vertices.back()));
    left_.resize(paths_.size());
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = static_cast<int>(i);
    // Of two paths with the same number of edges the shorter one comes first: a row before a diagonal.
    std::sort(left_.begin(), left_.end(), [&](int a, int b) {
      if (paths_[a].edges.size() != paths_[b].edges.size()) return paths_[a].edges.size() > paths_[b].edges.size();
      const double la = length_squared(along_[a]), lb = length_squared(along_[b]);
      return la != lb ? la < lb : a < b;
    });
  }

  std::vector<PathColour> colours() {
    std::vector<PathColour> colours;
    while (!left_.empty() && colour_ < most_careful_colours) colours.push_back(take());
    take_rest(colours);
    return colours;
  }

 private:
  bool is_free(const Path& path) const {
    return std::all_of(path.vertices.begin(), path.vertices.end(), [&](int v) { return taken_by_[v] != colour_; });
  }

  PathColour take() {
    ++colour_;
    const Vec3d along = along_[left_.front()];
    std::vector<std::pair<double, int>> order;  // minus |cosine| of the angle to the first path, and index in left_
    for (std::size_t i = 0; i < left_.size(); ++i)
      order.emplace_back(i == 0 ? -2 : -std::abs(cosine(along, along_[left_[i]])), static_cast<int>(i));
    std::sort(order.begin(), order.end());
    std::vector<char> taken(left_.size(), 0);
    for (const auto& [away, i] : order) {
      const Path& path = paths_[left_[i]];
      if (!is_free(path)) continue;
      for (int v : path.vertices) taken_by_[v] = colour_;
      taken[i] = 1;
    }
    return remove(taken, along);
  }

  PathColour remove(const std::vector<char>& taken, const Vec3d& along) {
    PathColour colour;
    std::vector<int> rest;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (!taken[i]) {
        rest.push_back(left_[i]);
        continue;
      }
      if (dot(along, along_[left_[i]]) < 0) reverse(paths_[left_[i]]);
      colour.paths.push_back(std::move(paths_[left_[i]]));
    }
    left_ = std::move(rest);
    std::sort(colour.paths.begin(), colour.paths.end(), [](const Path& a, const Path& b) {
      if (a.edges.size() != b.edges.size()) return a.edges.size() > b.edges.size();
      return a.vertices.front() < b.vertices.front();  // unique, because paths of a colour share no vertex
    });
    return colour;
  }

  /// Gives each path left the first new colour that comes after those of its vertices.
  void take_rest(std::vector<PathColour>& colours) {
    const std::size_t before = colours.size();
    std::vector<std::size_t> next(left_.empty() ? 0 : taken_by_.size(), 0);
    for (int i : left_) {
      std::size_t colour = 0;
      for (int v : paths_[i].vertices) colour = std::max(colour, next[v]);
      for (int v : paths_[i].vertices) next[v] = colour + 1;
      if (before + colour == colours.size()) colours.emplace_back();
      colours[before + colour].paths.push_back(std::move(paths_[i]));
    }
    left_.clear();
  }

  std::vector<Path> paths_;
  std::vector<Vec3d> along_;  // vector from the first to the last vertex of each path
  std::vector<int> left_;     // indices of the paths left, the longest first
  std::vector<int> taken_by_;
  int colour_ = 0;
};

std::size_t edge_count(const PathColour& colour) {
  std::size_t count = 0;
  for (const Path& path : colour.paths) count += path.edges.size();
  return count;
}

}  // namespace

std::vector<PathColour> lay_paths(const std::vector<Vec3f>& positions, const EdgeList& edges) {
  const Continuations next = join_straightest(positions, edges);
  std::vector<PathColour> colours =
      PathColouring(positions, Walker(edges, next, positions.size()).walk_all()).colours();
  std::stable_sort(colours.begin(), colours.end(),
                   [](const PathColour& a, const PathColour& b) { return edge_count(a) < edge_count(b); });
  return colours;
}

}  // namespace pliant
