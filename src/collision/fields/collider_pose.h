// Converts a scene's colliders for contact: a plain shape in its local frame, and the pose of that frame at a time.
#pragma once

#include "geometry/shapes.h"
#include "math/quat.h"
#include "pliant/scene.h"

namespace pliant {

/// Returns the shape as a kind and three sizes. Negative sizes, which a World rejects, count as 0.
LocalShape local_shape(const Shape& shape);

/// The pose of the collider's frame at `time` [s]: position, rotation and velocities.
Posed collider_pose(const Collider& collider, double time);

}  // namespace pliant
