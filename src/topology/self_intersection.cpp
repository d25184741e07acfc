// A sweep along the longest axis of the mesh: triangles are sorted by their lower bound, and each edge is tested with
// those that overlap it. It runs once, on meshes of some ten thousand triangles, so a BVH or a grid would not pay.
#include "topology/self_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {

namespace {

struct Box {
  std::array<float, 3> low, high;
};

std::array<float, 3> coordinates(const Vec3f& p) { return {p.x, p.y, p.z}; }

template <std::size_t N>
Box box_of(const std::vector<Vec3f>& positions, const std::array<int, N>& corners) {
  Box box{coordinates(positions[static_cast<std::size_t>(corners[0])]), {}};
  box.high = box.low;
  for (const int corner : corners) {
    const std::array<float, 3> p = coordinates(positions[static_cast<std::size_t>(corner)]);
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  return box;
}

bool overlap(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a.high[k] < b.low[k] || b.high[k] < a.low[k]) return false;
  return true;
}

Vec3d exact(const Vec3f& p) { return {p.x, p.y, p.z}; }

/// The sign of the volume of the tetrahedron a, b, c, d; 0 if it is below the rounding error. Differences are exact for
/// coordinates of similar size, so the bound covers the error of the three products and their sum.
int side(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double volume = dot(cross(u, v), w);
  const auto size = [](const Vec3d& p) { return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z); };
  constexpr double relative_error = 1e-14;
  const double doubt = relative_error * size(u) * size(v) * size(w);
  return volume > doubt ? 1 : volume < -doubt ? -1 : 0;
}

/// True if the open segment p-q crosses the interior of the triangle: its ends lie on different sides of the plane, and
/// the segment passes all three sides of the triangle with the same orientation.
bool pierces(const Vec3d& p, const Vec3d& q, const Vec3d (&t)[3]) {
  const int below = side(t[0], t[1], t[2], p);
  if (below == 0 || side(t[0], t[1], t[2], q) != -below) return false;
  const int turn = side(p, q, t[0], t[1]);
  return turn != 0 && side(p, q, t[1], t[2]) == turn && side(p, q, t[2], t[0]) == turn;
}

std::size_t longest_axis(const std::vector<Box>& boxes) {
  Box all = boxes.front();
  for (const Box& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      all.low[k] = std::min(all.low[k], box.low[k]);
      all.high[k] = std::max(all.high[k], box.high[k]);
    }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
  return axis;
}

bool share_vertex(const Edge& edge, const Triangle& triangle) {
  return std::any_of(triangle.begin(), triangle.end(),
                     [&](int corner) { return corner == edge.a || corner == edge.b; });
}

/// The triangles in the order of the sweep.
struct Sweep {
  std::size_t axis = 0;
  std::vector<Box> boxes;      ///< bounding boxes, sorted by low[axis]
  std::vector<int> triangles;  ///< index of the triangle in each box
  float longest = 0;           ///< largest extent of a box along the axis
};

Sweep sort_triangles(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) boxes.push_back(box_of(positions, t));
  Sweep sweep;
  sweep.axis = longest_axis(boxes);
  sweep.triangles.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) sweep.triangles[i] = static_cast<int>(i);
  const auto low = [&](int t) { return boxes[static_cast<std::size_t>(t)].low[sweep.axis]; };
  std::sort(sweep.triangles.begin(), sweep.triangles.end(),
            [&](int a, int b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  for (const int t : sweep.triangles) {
    sweep.boxes.push_back(boxes[static_cast<std::size_t>(t)]);
    sweep.longest = std::max(sweep.longest, sweep.boxes.back().high[sweep.axis] - sweep.boxes.back().low[sweep.axis]);
  }
  return sweep;
}

}  // namespace

SelfIntersections find_self_intersections(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles,
                                          const std::vector<Edge>& edges, std::uint64_t most_pairs) {
  SelfIntersections found;
  found.complete = true;
  if (triangles.empty()) return found;
  const Sweep sweep = sort_triangles(positions, triangles);
  std::uint64_t pairs = 0;
  for (const Edge& edge : edges) {
    const Box box = box_of(positions, std::array<int, 2>{edge.a, edge.b});
    // The rounding of this subtraction is harmless: a triangle missed by one rounding error can at most touch the edge.
    const float from = box.low[sweep.axis] - sweep.longest;
    auto i = static_cast<std::size_t>(
        std::lower_bound(sweep.boxes.begin(), sweep.boxes.end(), from,
                         [&](const Box& b, float value) { return b.low[sweep.axis] < value; }) -
        sweep.boxes.begin());
    const Vec3d p = exact(positions[static_cast<std::size_t>(edge.a)]);
    const Vec3d q = exact(positions[static_cast<std::size_t>(edge.b)]);
    for (; i < sweep.boxes.size() && sweep.boxes[i].low[sweep.axis] <= box.high[sweep.axis]; ++i) {
      if (++pairs > most_pairs) return {};
      if (!overlap(box, sweep.boxes[i])) continue;
      const int triangle = sweep.triangles[i];
      const Triangle& t = triangles[static_cast<std::size_t>(triangle)];
      if (share_vertex(edge, t)) continue;
      const Vec3d corners[3] = {exact(positions[static_cast<std::size_t>(t[0])]),
                                exact(positions[static_cast<std::size_t>(t[1])]),
                                exact(positions[static_cast<std::size_t>(t[2])])};
      if (!pierces(p, q, corners)) continue;
      if (found.count++ == 0) {
        found.edge[0] = edge.a;
        found.edge[1] = edge.b;
        found.triangle = triangle;
      }
    }
  }
  return found;
}

}  // namespace pliant
