// The Delaunay triangulation of points in a plane, for irregular meshes.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "pliant/mesh.h"

namespace pliant::testing_support {

struct FlatPoint {
  double x = 0, y = 0;
};

inline double twice_area(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// True if d lies in the circle through a, b and c, which are counterclockwise.
inline bool is_in_circle(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c, const FlatPoint& d) {
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  return (ax * ax + ay * ay) * (bx * cy - cx * by) - (bx * bx + by * by) * (ax * cy - cx * ay) +
             (cx * cx + cy * cy) * (ax * by - bx * ay) >
         0;
}

/// Points within some metres of the origin, one after the other (Bowyer 1981, Watson 1981), in the plane y = 0.
inline TriangleMesh delaunay_mesh(std::vector<FlatPoint> points) {
  const int count = static_cast<int>(points.size());
  points.insert(points.end(), {{-1000, -1000}, {2000, -1000}, {0, 3000}});
  const auto at = [&](int v) { return points[static_cast<std::size_t>(v)]; };
  std::vector<std::array<int, 3>> triangles{{count, count + 1, count + 2}};
  for (int v = 0; v < count; ++v) {
    std::set<std::pair<int, int>> sides;
    std::vector<std::array<int, 3>> kept;
    for (const auto& t : triangles) {
      if (!is_in_circle(at(t[0]), at(t[1]), at(t[2]), at(v))) {
        kept.push_back(t);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) sides.insert({t[k], t[(k + 1) % 3]});
    }
    for (const auto& [a, b] : sides)
      if (!sides.count({b, a})) kept.push_back({a, b, v});
    triangles.swap(kept);
  }
  TriangleMesh mesh;
  for (int v = 0; v < count; ++v)
    mesh.positions.push_back({static_cast<float>(at(v).x), 0, static_cast<float>(at(v).y)});
  for (const auto& [a, b, c] : triangles)
    if (a < count && b < count && c < count && twice_area(at(a), at(b), at(c)) > 1e-9)
      mesh.triangles.push_back({a, c, b});
  return mesh;
}

}  // namespace pliant::testing_support
