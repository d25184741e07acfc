// A convex solid as contact with a mesh sees it: in the mesh's frame.
#pragma once

#include <vector>

#include "collision/broad/bounds.h"
#include "geometry/convex_shape.h"

namespace pliant {

/// A convex solid in the frame of a mesh.
class SolidInMesh {
 public:
  /// By `turning` [m] its points may move against one another before contacts are found again.
  SolidInMesh(const ConvexShape& shape, const Posed& pose, double turning);

  const ConvexShape& shape() const { return shape_; }
  const Posed& pose() const { return pose_; }
  const Vec3d& centre() const { return centre_; }
  double radius() const { return static_cast<double>(shape_.radius); }
  double turning() const { return turning_; }
  double size() const { return size_; }  ///< about half its length, with the radius [m]
  bool is_polyhedron() const { return shape_.kind == ConvexShape::Kind::polyhedron; }
  const std::vector<Vec3d>& corners() const { return corners_; }  ///< of a polyhedron
  const std::vector<Vec3d>& normals() const { return normals_; }  ///< of a polyhedron's faces

  /// The core's farthest point in a direction.
  Vec3d support(const Vec3d& direction) const;
  /// The flat part of the core's surface that faces a direction.
  Feature feature(const Vec3d& direction, double slack) const;
  /// The solid displaced by so much [m].
  SolidInMesh moved(const Vec3d& displacement) const;
  /// A box around the solid, grown by a margin [m].
  BoxBounds box(double margin) const;

 private:
  const ConvexShape& shape_;
  Posed pose_;
  Vec3d centre_{};
  double size_ = 0, turning_ = 0;
  std::vector<Vec3d> corners_, normals_;
};

}  // namespace pliant
