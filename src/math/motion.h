// Where a motion by keyframes has taken its frame at a given time.
//
// Evaluated in double and rounded once: a substep may last a hundred thousandth of a second, and what a float loses of a
// pose would come back as a speed a hundred thousand times as large.
#pragma once

#include <cstddef>
#include <vector>

#include "math/quat.h"
#include "pliant/motion.h"

namespace pliant {

/// The rigid transform of `motion` at `time` [s]: translations linear and rotations at even angular speed along the shorter
/// arc between keyframes, held before the first and after the last, or begun again there where it repeats. The identity
/// without keyframes. Keyframes are finite and their times increase, which a World checks; in any other order some pose
/// results.
Posed pose_at(const Motion& motion, double time);

/// Between which of increasing times a moment lies, and how far on the way from one to the other.
struct TimePlace {
  std::size_t before = 0, after = 0;
  double share = 0;
};

/// Before the first time and after the last it is held there, or begun again after the last where it repeats. At least one time.
TimePlace place_in(const std::vector<float>& times, bool repeat, double time);

/// A point that `pose` carries along, from its place at rest.
PLIANT_HD Vec3f carried(const Posed& pose, const Vec3f& rest) {
  return convert<float>(to_world(pose, convert<double>(rest)));
}

}  // namespace pliant
