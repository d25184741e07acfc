// Where a motion by keyframes has taken its frame at a given time.
//
// Evaluated in double and rounded once: a substep may last a hundred thousandth of a second, and what a float loses of a
// pose would come back as a speed a hundred thousand times as large.
#pragma once

#include "math/quat.h"
#include "pliant/motion.h"

namespace pliant {

/// The rigid transform of `motion` at `time` [s]: translations linear and rotations at even angular speed along the shorter
/// arc between keyframes, held before the first and after the last, or begun again there where it repeats. The identity
/// without keyframes. Keyframes are finite and their times increase, which a World checks; in any other order some pose
/// results.
Posed pose_at(const Motion& motion, double time);

/// A point that `pose` carries along, from its place at rest.
PLIANT_HD Vec3f carried(const Posed& pose, const Vec3f& rest) {
  return convert<float>(to_world(pose, convert<double>(rest)));
}

}  // namespace pliant
