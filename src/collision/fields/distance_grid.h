// Signed distance field of a closed mesh, sampled on a grid:
// penetration depth and direction at a cost independent of the mesh.
//
// The grid smooths features finer than its spacing, and queries at the points of another surface miss what lies between
// them. Use it for culling, signs and recovery from deep penetration. It is built once and can be cached.
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
  /// Samples a closed mesh at nodes `spacing` [m] apart over its box grown by `padding` [m]. Throws an Error if an edge
  /// has not two triangles, a size is not positive and finite, or more than 2^27 nodes would result.
  DistanceGrid(const MeshQuery& mesh, float spacing, float padding, Executor& executor);

  /// Uses a given field. Throws an Error unless it has two nodes or more per axis and one finite number for each node.
  explicit DistanceGrid(std::shared_ptr<const DistanceField> field);

  /// The signed distance at p, negative inside [m], and its gradient's direction. The distance is trilinear between
  /// nodes, so continuous; its error is below half a cell's diagonal. Outside the grid it is the value at the grid's
  /// nearest point plus the distance to that point. The direction is a unit vector; +y if the gradient vanishes.
  SurfaceDistance<float> sample(const Vec3f& p) const;

  const BoxBounds& bounds() const { return bounds_; }
  float spacing() const { return field_->spacing; }
  int node_count(int axis) const { return field_->nodes[static_cast<std::size_t>(axis)]; }
  const std::shared_ptr<const DistanceField>& field() const { return field_; }

 private:
  std::shared_ptr<const DistanceField> field_;
  BoxBounds bounds_;
};

/// Throws an Error if the mesh is empty or an edge does not have exactly two triangles.
void require_closed(const std::vector<Triangle>& triangles, int vertices);

}  // namespace pliant
