// Motion by keyframes, for pins, targets of attachments, and colliders.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A rigid pose at one time.
struct Keyframe {
  float time = 0;    ///< time [s]; increases from keyframe to keyframe
  Vec3f position{};  ///< translation [m]
  Quatf rotation{};  ///< unit quaternion
};

/// A rigid motion p -> R(t) (p - pivot) + pivot + position(t). Between keyframes it is linear, with rotations on the
/// shorter arc. It is constant before the first keyframe and, unless `repeat`, after the last; static without
/// keyframes.
struct Motion {
  std::vector<Keyframe> keyframes;
  Vec3f pivot{};        ///< centre of rotation [m]
  bool repeat = false;  ///< true: restart at the first keyframe after the last

  bool moves() const { return !keyframes.empty(); }
};

/// A pose of a collider or body: a point p of its local frame is at rotation p + position.
struct RigidPose {
  Vec3f position{};  ///< position of the local frame's origin [m]
  Quatf rotation{};  ///< quaternion of any non-zero length
};

/// The rotation by `degrees` about `axis` (of any non-zero length), with the same bits on every machine. Throws an
/// Error if the axis is zero or a number is not finite.
Quatf rotation(const Vec3f& axis, float degrees);

}  // namespace pliant
