// Conversion of vectors for Bullet.
#pragma once

#include <LinearMath/btVector3.h>

#include "pliant/vec3.h"

namespace pliant::bench {

inline btVector3 to_bullet(const Vec3f& v) { return {v.x, v.y, v.z}; }

}  // namespace pliant::bench
