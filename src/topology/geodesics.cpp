#include "topology/geodesics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

namespace pliant {

namespace {

struct Neighbour {
  int vertex;
  double length;
};

/// A triangle at one of its vertices.
struct Corner {
  int next, last;                   ///< the triangle's other two vertices
  double to_next, to_last, across;  ///< distances from the vertex to the other two, and between those
};

/// The distance from a source to the third corner of a triangle, if the triangles are unfolded into a plane. The source
/// is `da` and `db` away from the ends of a side of length `side`. The third corner, on the other side of it, is `ca`
/// and `cb` away from them. Returns infinity if the straight line does not cross the side.
double unfolded(double da, double db, double side, double ca, double cb) {
  const double none = HUGE_VAL;
  if (!(side > 0)) return none;
  const double sx = (da * da - db * db + side * side) / (2 * side), sy2 = da * da - sx * sx;
  const double cx = (ca * ca - cb * cb + side * side) / (2 * side), cy2 = ca * ca - cx * cx;
  if (!(cy2 > 0)) return none;
  const double sy = std::sqrt(std::max(sy2, 0.0)), cy = std::sqrt(cy2);
  const double crossing = sx + (cx - sx) * (sy / (sy + cy));
  if (!(crossing >= 0 && crossing <= side)) return none;
  return std::sqrt((cx - sx) * (cx - sx) + (cy + sy) * (cy + sy));
}

/// What is at each of some vertices, in compressed rows.
template <class T>
class AtVertices {
 public:
  /// `visit(add)` calls add(vertex, item) for each item, twice in the same order.
  template <class Visit>
  AtVertices(std::size_t vertices, const Visit& visit) : first_(vertices + 2) {
    visit([this](int vertex, const T&) { ++first_[static_cast<std::size_t>(vertex) + 2]; });
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    items_.resize(first_.back());
    visit([this](int vertex, const T& item) { items_[first_[static_cast<std::size_t>(vertex) + 1]++] = item; });
  }

  std::span<const T> operator[](int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return {items_.data() + first_[v], items_.data() + first_[v + 1]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<T> items_;
};

AtVertices<Neighbour> neighbours_of(const Distances& mesh) {
  return {static_cast<std::size_t>(mesh.vertices), [&](const auto& add) {
            for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
              const auto [a, b] = mesh.edges[e];
              add(a, Neighbour{b, mesh.lengths[e]});
              add(b, Neighbour{a, mesh.lengths[e]});
            }
          }};
}

/// The length of the shortest edge between two vertices; infinity if there is none.
double length_between(const AtVertices<Neighbour>& neighbours, int a, int b) {
  double length = HUGE_VAL;
  if (neighbours[b].size() < neighbours[a].size()) std::swap(a, b);
  for (const Neighbour& n : neighbours[a])
    if (n.vertex == b) length = std::min(length, n.length);
  return length;
}

AtVertices<Corner> corners_of(const Distances& mesh, const AtVertices<Neighbour>& neighbours) {
  return {static_cast<std::size_t>(mesh.vertices), [&](const auto& add) {
            for (const auto& [a, b, c] : mesh.triangles) {
              const double ab = length_between(neighbours, a, b), bc = length_between(neighbours, b, c),
                           ca = length_between(neighbours, c, a);
              if (!(std::max({ab, bc, ca}) < HUGE_VAL)) continue;
              add(a, Corner{b, c, ab, ca, bc});
              add(b, Corner{c, a, bc, ab, ca});
              add(c, Corner{a, b, ca, bc, ab});
            }
          }};
}

class Search {
 public:
  explicit Search(const Distances& mesh)
      : vertices_(static_cast<std::size_t>(mesh.vertices)),
        neighbours_(neighbours_of(mesh)),
        corners_(corners_of(mesh, neighbours_)),
        group_of_(vertices_, -1),
        offered_(vertices_, {-1, HUGE_VAL}) {}

  std::vector<std::vector<NearSource>> run(const std::vector<int>& sources, int most) {
    group(sources);
    std::vector<std::vector<NearSource>> found(vertices_);
    for (int source : sources) waiting_.emplace(0.0, source, source);
    while (!waiting_.empty()) {
      const auto [distance, vertex, source] = waiting_.top();
      waiting_.pop();
      if (!accept(found[vertex], {source, distance}, most)) continue;
      for (const Neighbour& n : neighbours_[vertex])
        offer(found[n.vertex], distance + n.length, n.vertex, source, most);
      for (const Corner& c : corners_[vertex]) {
        cross_to(c.last, c.next, distance, source, {c.to_next, c.to_last, c.across}, found, most);
        cross_to(c.next, c.last, distance, source, {c.to_last, c.to_next, c.across}, found, most);
      }
    }
    return found;
  }

 private:
  /// Numbers the groups of sources: sources connected by edges form one group.
  void group(const std::vector<int>& sources) {
    std::vector<char> is_source(vertices_, 0);
    for (int source : sources) is_source[source] = 1;
    int groups = 0;
    std::vector<int> stack;
    for (int first : sources) {
      if (group_of_[first] >= 0) continue;
      group_of_[first] = groups;
      stack.push_back(first);
      while (!stack.empty()) {
        const int v = stack.back();
        stack.pop_back();
        for (const Neighbour& n : neighbours_[v]) {
          if (!is_source[n.vertex] || group_of_[n.vertex] >= 0) continue;
          group_of_[n.vertex] = groups;
          stack.push_back(n.vertex);
        }
      }
      ++groups;
    }
  }

  bool is_wanted(const std::vector<NearSource>& found, int source, int most) const {
    return static_cast<int>(found.size()) < most &&
           std::none_of(found.begin(), found.end(),
                        [&](const NearSource& other) { return group_of_[other.source] == group_of_[source]; });
  }

  bool accept(std::vector<NearSource>& found, const NearSource& source, int most) const {
    if (!is_wanted(found, source.source, most)) return false;
    found.push_back(source);
    return true;
  }

  /// Of two offers of a group the one that is taken first is accepted, so what is behind the last one that waits is
  /// left out.
  void offer(const std::vector<NearSource>& found, double distance, int vertex, int source, int most) {
    if (!(distance < HUGE_VAL) || !is_wanted(found, source, most)) return;
    NearSource& last = offered_[static_cast<std::size_t>(vertex)];
    const bool is_of_group = last.source >= 0 && group_of_[last.source] == group_of_[source];
    if (is_of_group && std::tie(last.distance, last.source) <= std::tie(distance, source)) return;
    last = {source, distance};
    waiting_.emplace(distance, vertex, source);
  }

  struct Sides {
    double to_other, to_target, across;  ///< distances from the vertex to both, and between both
  };

  /// Shortens the distance of `target` by a straight path through a triangle, if its vertex `other` has been reached
  /// from the source.
  void cross_to(int target, int other, double distance, int source, const Sides& sides,
                const std::vector<std::vector<NearSource>>& found, int most) {
    for (const NearSource& reached : found[other]) {
      if (reached.source != source) continue;
      const double there = unfolded(distance, reached.distance, sides.to_other, sides.to_target, sides.across);
      offer(found[target], std::max(there, distance), target, source, most);
    }
  }

  using Entry = std::tuple<double, int, int>;  // distance, vertex, source
  std::size_t vertices_;
  AtVertices<Neighbour> neighbours_;
  AtVertices<Corner> corners_;
  std::vector<int> group_of_;
  std::vector<NearSource> offered_;  ///< to each vertex last; no source: nothing yet
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting_;
};

}  // namespace

std::vector<std::vector<NearSource>> nearest_sources(const Distances& mesh, const std::vector<int>& sources, int most) {
  return Search(mesh).run(sources, most);
}

}  // namespace pliant
