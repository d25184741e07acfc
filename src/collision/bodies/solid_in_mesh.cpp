#include "collision/bodies/solid_in_mesh.h"

#include <algorithm>
#include <cstddef>

#include "geometry/convex_contact.h"
#include "math/vector.h"

namespace pliant {

SolidInMesh::SolidInMesh(const ConvexShape& shape, const Posed& pose, double turning)
    : shape_(shape), pose_(pose), centre_(pose.position), turning_(turning) {
  size_ = radius() + static_cast<double>(std::max(shape.core_radius, shape.half_length));
  if (!is_polyhedron()) return;
  const Polyhedron& p = *shape.polyhedron;
  centre_ = to_world(pose, convert<double>(p.centre));
  size_ = radius() + static_cast<double>(largest(p.corners[0] - p.centre));
  corners_.reserve(p.corners.size());
  for (const Vec3f& corner : p.corners) corners_.push_back(to_world(pose, convert<double>(corner)));
  normals_.reserve(p.normals.size());
  for (const Vec3f& normal : p.normals) normals_.push_back(rotate(pose.rotation, convert<double>(normal)));
}

Vec3d SolidInMesh::support(const Vec3d& direction) const {
  if (!is_polyhedron()) return to_world(pose_, pliant::support(shape_, rotate(conjugate(pose_.rotation), direction)));
  std::size_t best = 0;
  double most = dot(direction, corners_[0]);
  for (std::size_t i = 1; i < corners_.size(); ++i) {
    const double reach = dot(direction, corners_[i]);
    if (reach <= most) continue;
    most = reach;
    best = i;
  }
  return corners_[best];
}

Feature SolidInMesh::feature(const Vec3d& direction, double slack) const {
  return feature_towards(shape_, pose_, direction, slack);
}

SolidInMesh SolidInMesh::moved(const Vec3d& displacement) const {
  SolidInMesh out = *this;
  out.pose_.position += displacement;
  out.centre_ += displacement;
  for (Vec3d& corner : out.corners_) corner += displacement;
  return out;
}

BoxBounds SolidInMesh::box(double margin) const {
  const double grown = radius() + margin;
  const Vec3d high{support({1, 0, 0}).x + grown, support({0, 1, 0}).y + grown, support({0, 0, 1}).z + grown};
  const Vec3d low{support({-1, 0, 0}).x - grown, support({0, -1, 0}).y - grown, support({0, 0, -1}).z - grown};
  return {{detail::float_below(low.x), detail::float_below(low.y), detail::float_below(low.z)},
          {detail::float_above(high.x), detail::float_above(high.y), detail::float_above(high.z)}};
}

}  // namespace pliant
