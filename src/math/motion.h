// Computes the pose of a motion with keyframes at a given time.
//
// Poses are computed in double precision and rounded once: a substep can be as short as 1e-5 s, and the float rounding
// error of a pose would become a velocity error 1e5 times as large.
#pragma once

#include <cstddef>
#include <vector>

#include "math/quat.h"
#include "pliant/motion.h"

namespace pliant {

/// The rigid transform of `motion` at `time` [s]. Between keyframes translation is linear and
/// rotation is slerp along the shorter arc. Before the first keyframe and after the last the pose is
/// constant; a repeating motion restarts after the last. The identity without keyframes. Keyframes
/// must be finite with increasing times, which a World checks; otherwise the pose is unspecified.
Posed pose_at(const Motion& motion, double time);

/// Where a time lies in an increasing list of times: the interval, and the share within it.
struct TimePlace {
  std::size_t before = 0, after = 0;
  double share = 0;
};

/// Finds a time in a list of one or more. Times outside are clamped; a repeating list restarts after its last time.
TimePlace place_in(const std::vector<float>& times, bool repeat, double time);

/// The world position of a rest point that moves with `pose`.
PLIANT_HD Vec3f carried(const Posed& pose, const Vec3f& rest) {
  return convert<float>(to_world(pose, convert<double>(rest)));
}

}  // namespace pliant
