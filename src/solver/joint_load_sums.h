// Sums of the loads of joints over the substeps of a frame, for their means.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// The sums of an object's joints: load times the length of the substep.
struct JointLoadSums {
  std::vector<Vec3d> forces, torques;  ///< by joint [N s], [N m s]
  double time = 0;                     ///< of the substeps so far [s]
  bool is_complete = true;             ///< the step that was summed has ended, and the next one starts again
};

struct Substep;

/// Adds the loads of all joints of the substep's objects, after its solve. Sums of an earlier step start again from
/// zero.
void add_joint_loads(const Substep& s);

}  // namespace pliant
