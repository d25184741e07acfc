// Signed distances to a closed mesh, kept at the nodes of a grid: how deep, and which way out, at a cost that does not depend on
// the mesh.
//
// A grid rounds off what is finer than its spacing, and points alone miss features of what is tested against it; it serves for
// culling, for signs and for bringing back what is deep inside. It is made once and may be kept.
#pragma once

#include <vector>

#include "collision/mesh_query.h"
#include "geometry/shapes.h"
#include "parallel/executor.h"

namespace pliant {

class DistanceGrid {
 public:
  /// Measures a mesh, which must be closed, at nodes `spacing` [m] apart over its box grown by `padding` [m]. Throws Error where an
  /// edge has not two triangles, a size is not positive and finite, or there would be more than 2^27 nodes.
  DistanceGrid(const MeshQuery& mesh, float spacing, float padding, Executor& executor);

  /// The distance at p, negative inside [m], and the direction in which it grows; trilinear between nodes, so continuous, and
  /// off by less than half a cell's diagonal. Beyond the grid: its value at the nearest point of the grid plus the way there, which
  /// is at least the true distance less that error. The direction is of unit length; +y where the grid shows none.
  SurfaceDistance<float> sample(const Vec3f& p) const;

  const BoxBounds& bounds() const { return bounds_; }
  float spacing() const { return spacing_; }
  int node_count(int axis) const { return counts_[axis]; }

 private:
  void measure_row(const MeshQuery& mesh, int row);
  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(counts_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3f node(int x, int y, int z) const;

  BoxBounds bounds_;
  float spacing_;
  int counts_[3] = {2, 2, 2};  ///< nodes along x, y, z
  std::vector<float> distances_;
};

}  // namespace pliant
