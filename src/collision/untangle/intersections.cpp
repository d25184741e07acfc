// Finds intersections: a BVH of triangles gives those near each edge's box, geometry/exact.h the exact signs.
#include "collision/untangle/intersections.h"

#include <algorithm>
#include <tuple>

namespace pliant {

namespace {

bool share_vertex(const Edge& edge, const Triangle& t) {
  return std::any_of(t.begin(), t.end(), [&](int corner) { return corner == edge.a || corner == edge.b; });
}

}  // namespace

IntersectionFinder::IntersectionFinder(const std::vector<Triangle>& triangles, int vertex_count)
    : triangles_(triangles), edges_(find_edges(triangles, vertex_count)), boxes_(triangles.size()) {}

const std::vector<Intersection>& IntersectionFinder::find(const std::vector<Vec3f>& positions, bool touching) {
  const auto at = [&](int vertex) { return positions[static_cast<std::size_t>(vertex)]; };
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Vec3f corners[3] = {at(triangles_[i][0]), at(triangles_[i][1]), at(triangles_[i][2])};
    boxes_[i] = BoxBounds::of(corners, 3);
  }
  tree_.build(boxes_);
  found_.clear();
  for (const Edge& edge : edges_) {
    const Vec3f ends[2] = {at(edge.a), at(edge.b)};
    tree_.query(BoxBounds::of(ends, 2), [&](int triangle) {
      const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
      if (share_vertex(edge, t)) return;
      const EdgeTriangle kind = how_edge_meets_triangle(ends, {at(t[0]), at(t[1]), at(t[2])});
      if (kind == EdgeTriangle::crossing || (touching && kind == EdgeTriangle::touching))
        found_.push_back({edge.a, edge.b, triangle, kind});
    });
  }
  std::sort(found_.begin(), found_.end(), [](const Intersection& x, const Intersection& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  });
  return found_;
}

}  // namespace pliant
