// Keyframed motion of pins, attachment targets and colliders.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A rigid pose at a time.
struct Keyframe {
  float time = 0;    ///< [s], increasing along a motion
  Vec3f position{};  ///< translation [m]
  Quatf rotation{};  ///< unit quaternion
};

/// A rigid motion p -> R(t) (p - pivot) + pivot + position(t): linear between keyframes, with rotations along the shorter
/// arc. It is constant before the first keyframe and, unless `repeat`, after the last. Without keyframes it is static.
struct Motion {
  std::vector<Keyframe> keyframes;
  Vec3f pivot{};        ///< centre of rotation [m]
  bool repeat = false;  ///< restart after the last keyframe

  bool moves() const { return !keyframes.empty(); }
};

/// The rotation by `degrees` about `axis` (any non-zero length), with the same bits on every machine. Throws an Error if
/// the axis is zero or a number is not finite.
Quatf rotation(const Vec3f& axis, float degrees);

}  // namespace pliant
