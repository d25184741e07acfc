// Which joints of an object are those of rods.
#pragma once

#include <algorithm>

#include "pliant/scene.h"

namespace pliant {

/// True for the joints that add_rod makes between segments, and of ends that are clamped.
inline bool is_of_rod(const ObjectJoint& joint) { return joint.kind == "rod"; }

inline bool has_rods(const Object& object) { return std::any_of(object.joints.begin(), object.joints.end(), is_of_rod); }

}  // namespace pliant
