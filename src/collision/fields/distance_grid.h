// Signed distances to a closed mesh, kept at the nodes of a grid: how deep, and which way out, at a cost that does not depend on
// the mesh.
//
// A grid rounds off what is finer than its spacing, and points alone miss features of what is tested against it; it serves for
// culling, for signs and for bringing back what is deep inside. It is made once and may be kept.
#pragma once

#include <memory>
#include <vector>

#include "collision/fields/mesh_query.h"
#include "geometry/shapes.h"
#include "parallel/executor.h"
#include "pliant/scene.h"

namespace pliant {

class DistanceGrid {
 public:
  /// Measures a mesh, which must be closed, at nodes `spacing` [m] apart over its box grown by `padding` [m]. Throws Error where an
  /// edge has not two triangles, a size is not positive and finite, or there would be more than 2^27 nodes.
  DistanceGrid(const MeshQuery& mesh, float spacing, float padding, Executor& executor);

  /// As measured before. Throws Error where it has not two nodes or more along each axis, one number each, all finite.
  explicit DistanceGrid(std::shared_ptr<const DistanceField> field);

  /// The distance at p, negative inside [m], and the direction in which it grows; trilinear between nodes, so continuous, and
  /// off by less than half a cell's diagonal. Beyond the grid: its value at the nearest point of the grid plus the way there, which
  /// is at least the true distance less that error. The direction is of unit length; +y where the grid shows none.
  SurfaceDistance<float> sample(const Vec3f& p) const;

  const BoxBounds& bounds() const { return bounds_; }
  float spacing() const { return field_->spacing; }
  int node_count(int axis) const { return field_->nodes[static_cast<std::size_t>(axis)]; }
  const std::shared_ptr<const DistanceField>& field() const { return field_; }

 private:
  std::shared_ptr<const DistanceField> field_;
  BoxBounds bounds_;
};

/// Throws Error where an edge of the mesh has not two triangles, or it has none.
void require_closed(const std::vector<Triangle>& triangles, int vertices);

}  // namespace pliant
