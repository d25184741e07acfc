// A scene's colliders in the form that contacts use: a plain shape in its own frame, and where that frame is at a time.
#pragma once

#include "geometry/shapes.h"
#include "math/quat.h"
#include "pliant/scene.h"

namespace pliant {

/// The shape as a kind and three numbers. Sizes below zero, which a World refuses, count as 0.
LocalShape local_shape(const Shape& shape);

/// Where the collider's frame is at `time` [s]: its position and rotation, then its motion.
Posed collider_pose(const Collider& collider, double time);

}  // namespace pliant
