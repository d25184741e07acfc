// The parts of a Record as a vector or a quaternion.
#pragma once

#include "pliant/state.h"
#include "pliant/vec3.h"

namespace pliant {

PLIANT_HD Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }
PLIANT_HD Quatf quaternion(const Record& r) { return {r.x, r.y, r.z, r.w}; }

}  // namespace pliant
