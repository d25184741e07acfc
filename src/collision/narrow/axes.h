// The frame of a collider as its three axes in world coordinates.
#pragma once

#include "geometry/shapes.h"
#include "math/motion.h"

namespace pliant {

/// A transformation into this frame is three dot products instead of a rotation.
struct Axes {
  Vec3f x, y, z, origin;

  explicit Axes(const Pose<float>& pose)
      : x(rotate(pose.rotation, Vec3f{1, 0, 0})),
        y(rotate(pose.rotation, Vec3f{0, 1, 0})),
        z(rotate(pose.rotation, Vec3f{0, 0, 1})),
        origin(pose.position) {}

  Vec3f to_local(const Vec3f& p) const {
    const Vec3f d = p - origin;
    return {dot(x, d), dot(y, d), dot(z, d)};
  }
  /// Half extents, in this frame, of a box that encloses a box with half extents `e` in the world.
  Vec3f extent(const Vec3f& e) const { return {dot(abs(x), e), dot(abs(y), e), dot(abs(z), e)}; }
};

}  // namespace pliant
