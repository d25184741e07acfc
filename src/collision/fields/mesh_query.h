// What lies where about a triangle mesh: the closest point of its surface, and whether a point is inside.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "geometry/triangle.h"
#include "topology/edges.h"

namespace pliant {

/// The closest point of a surface.
struct SurfacePoint {
  int triangle = -1;  ///< the first of equally near ones; -1: none within the limit
  Vec3f point{};
  Vec3f weights{};     ///< barycentric
  float distance = 0;  ///< [m]
};

/// A triangle mesh with a hierarchy over it. Holds a copy of the mesh; queries may run on many threads at once.
class MeshQuery {
 public:
  /// Positions finite and below 1e15 m; indices in range (require_indices).
  MeshQuery(std::vector<Vec3f> positions, std::vector<Triangle> triangles);

  /// Moves the vertices, as many as there were, and refits.
  void move(const std::vector<Vec3f>& positions);

  /// The surface point closest to p among those nearer than `limit`.
  SurfacePoint closest(const Vec3f& p, float limit = 3e38f) const;

  /// How many times the surface winds about p: the sum of the signs in which a ray from p leaves through it. Exact: rays that
  /// graze an edge or a corner are given up for others. 0 outside, 1 inside a closed mesh wound outward, -1 inward; 2 in
  /// two at once. On the surface itself, 0. Open meshes have no inside: there the answer depends on the ray.
  int winding_number(const Vec3f& p) const;

  bool is_inside(const Vec3f& p) const { return winding_number(p) != 0; }

  const std::vector<Vec3f>& positions() const { return positions_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const BoxBounds& bounds() const { return bounds_; }

 private:
  void fit();

  std::vector<Vec3f> positions_;
  std::vector<Triangle> triangles_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  BoxBounds bounds_;  ///< of all
};

}  // namespace pliant
