// Sums of the loads of joints over the substeps of a frame, for their means.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// The sums of an object's joints: load times the length of the substep.
struct JointLoadSums {
  std::vector<Vec3d> forces, torques;  ///< by joint [N s], [N m s]
  double time = 0;                     ///< of the substeps so far [s]
  std::int64_t frame = -1;             ///< State::frame of the frame that was summed; -1: none
};

struct Substep;

/// Adds the loads of all joints of the substep's objects, after its solve. Sums of an earlier frame are started anew.
void add_joint_loads(const Substep& s);

}  // namespace pliant
