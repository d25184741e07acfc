// Point queries on a triangle mesh: the closest surface point, and the winding number.
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

/// A triangle mesh with a BVH. Holds a copy of the mesh; queries are thread-safe.
class MeshQuery {
 public:
  /// Positions must be finite and below 1e15 m, indices in range (require_indices).
  MeshQuery(std::vector<Vec3f> positions, std::vector<Triangle> triangles);

  /// Moves the vertices (the same number) and refits.
  void move(const std::vector<Vec3f>& positions);

  /// The surface point closest to p within `limit`.
  SurfacePoint closest(const Vec3f& p, float limit = 3e38f) const;

  /// The winding number of the surface about p: the signed crossings of a ray from p. Exact: rays that graze an edge or a
  /// corner are replaced. 0 outside; 1 inside a closed mesh wound outward, -1 inward; 2 inside two at once; 0 on the
  /// surface. For open meshes the result depends on the ray.
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
  BoxBounds bounds_;  ///< of all triangles
};

}  // namespace pliant
