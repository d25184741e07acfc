#include "topology/geodesics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

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

class Search {
 public:
  explicit Search(const Distances& mesh)
      : neighbours_(mesh.vertices), corners_(mesh.vertices), group_of_(mesh.vertices, -1) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      neighbours_[mesh.edges[e][0]].push_back({mesh.edges[e][1], mesh.lengths[e]});
      neighbours_[mesh.edges[e][1]].push_back({mesh.edges[e][0], mesh.lengths[e]});
    }
    add_corners(mesh);
  }

  std::vector<std::vector<NearSource>> run(const std::vector<int>& sources, int most) {
    group(sources);
    std::vector<std::vector<NearSource>> found(neighbours_.size());
    for (int source : sources) waiting_.emplace(0.0, source, source);
    while (!waiting_.empty()) {
      const auto [distance, vertex, source] = waiting_.top();
      waiting_.pop();
      if (!accept(found[vertex], {source, distance}, most)) continue;
      for (const Neighbour& n : neighbours_[vertex]) offer(found[n.vertex], distance + n.length, n.vertex, source, most);
      for (const Corner& c : corners_[vertex]) {
        cross_to(c.last, c.next, distance, source, {c.to_next, c.to_last, c.across}, found, most);
        cross_to(c.next, c.last, distance, source, {c.to_last, c.to_next, c.across}, found, most);
      }
    }
    return found;
  }

 private:
  void add_corners(const Distances& mesh) {
    std::vector<std::tuple<int, int, double>> known;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      const auto [a, b] = std::minmax(mesh.edges[e][0], mesh.edges[e][1]);
      known.emplace_back(a, b, mesh.lengths[e]);
    }
    std::sort(known.begin(), known.end());
    const auto length = [&](int a, int b) {
      const auto [low, high] = std::minmax(a, b);
      const auto at = std::lower_bound(known.begin(), known.end(), std::make_tuple(low, high, -1.0));
      return at != known.end() && std::get<0>(*at) == low && std::get<1>(*at) == high ? std::get<2>(*at) : -1.0;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const double ab = length(a, b), bc = length(b, c), ca = length(c, a);
      if (ab < 0 || bc < 0 || ca < 0) continue;
      corners_[a].push_back({b, c, ab, ca, bc});
      corners_[b].push_back({c, a, bc, ab, ca});
      corners_[c].push_back({a, b, ca, bc, ab});
    }
  }

  /// Numbers the groups of sources: sources connected by edges form one group.
  void group(const std::vector<int>& sources) {
    std::vector<char> is_source(neighbours_.size(), 0);
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
    return static_cast<int>(found.size()) < most && std::none_of(found.begin(), found.end(), [&](const NearSource& other) {
             return group_of_[other.source] == group_of_[source];
           });
  }

  bool accept(std::vector<NearSource>& found, const NearSource& source, int most) const {
    if (!is_wanted(found, source.source, most)) return false;
    found.push_back(source);
    return true;
  }

  void offer(const std::vector<NearSource>& found, double distance, int vertex, int source, int most) {
    if (distance < HUGE_VAL && is_wanted(found, source, most)) waiting_.emplace(distance, vertex, source);
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
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<std::vector<Corner>> corners_;
  std::vector<int> group_of_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting_;
};

}  // namespace

std::vector<std::vector<NearSource>> nearest_sources(const Distances& mesh, const std::vector<int>& sources, int most) {
  return Search(mesh).run(sources, most);
}

}  // namespace pliant
