// Motion by keyframes, of pins, attachment targets and colliders.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A rigid pose at a moment.
struct Keyframe {
  float time = 0;    ///< [s], increasing along a motion
  Vec3f position{};  ///< translation [m]
  Quatf rotation{};  ///< unit quaternion
};

/// A rigid motion p -> R(t) (p - pivot) + pivot + position(t), linear between keyframes (rotations along the shorter arc,
/// normalised), held before the first and after the last unless `repeat`. Without keyframes it stands still.
struct Motion {
  std::vector<Keyframe> keyframes;
  Vec3f pivot{};        ///< point that rotations leave in place [m]
  bool repeat = false;  ///< start again after the last keyframe

  bool moves() const { return !keyframes.empty(); }
};

/// The rotation by `degrees` about `axis` (any length but zero), in the same bits on every machine. Throws Error where the axis
/// has no direction or a number is not finite.
Quatf rotation(const Vec3f& axis, float degrees);

}  // namespace pliant
