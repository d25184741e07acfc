// Point queries on a triangle mesh: the closest surface point, and the winding number.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "geometry/triangle.h"
#include "topology/edges.h"

namespace pliant {

/// The closest point of a surface.
struct SurfacePoint {
  int triangle = -1;  ///< index of the triangle, the first of equally near ones; -1: none within the limit
  Vec3f point{};
  Vec3f weights{};     ///< barycentric coordinates of the closest point
  float distance = 0;  ///< distance from the query point [m]
};

/// A triangle mesh with a BVH. It holds a copy of the mesh; concurrent queries are safe.
class MeshQuery {
 public:
  /// Positions must be finite and below 1e15 m, indices in range (require_indices).
  MeshQuery(std::vector<Vec3f> positions, std::vector<Triangle> triangles);

  /// Moves the vertices, whose number stays the same, and refits the BVH.
  void move(const std::vector<Vec3f>& positions);

  /// The surface point closest to p within `limit`.
  SurfacePoint closest(const Vec3f& p, float limit = 3e38f) const;

  /// The winding number of the surface about p: the number of signed crossings of a ray from p. The result is exact: a
  /// ray that grazes an edge or a corner is replaced by another one. 0 outside; 1 inside a closed mesh wound outward,
  /// -1 inward; 2 where two meshes overlap; 0 on the surface. For open meshes the result depends on the ray.
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
  BoxBounds bounds_;  ///< box around all triangles
};

}  // namespace pliant
