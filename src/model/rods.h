// Which joints of an object are those of rods.
#pragma once

#include <algorithm>

#include "pliant/scene.h"

namespace pliant {

/// True for the joints that add_rod makes between segments, and of ends that are clamped.
inline bool is_of_rod(const ObjectJoint& joint) { return joint.kind == "rod"; }

/// The particle of the fixed body that stands for the world, where joints and rods are held; -1: there is none. It is
/// at the origin, wherever the object is.
inline int world_particle(const Object& object) {
  for (const ObjectBody& body : object.bodies)
    if (body.name == "world" && body.solids.empty()) return body.particle;
  return -1;
}

inline bool has_rods(const Object& object) {
  return std::any_of(object.joints.begin(), object.joints.end(), is_of_rod);
}

}  // namespace pliant
