// Contact points of any two convex solids.
#pragma once

#include "geometry/touch.h"

namespace pliant {

/// The feature towards a direction (convex_shape.h) of a solid with a pose, in the frame of that pose.
Feature feature_towards(const ConvexShape& shape, const Posed& pose, const Vec3d& direction, double slack);

/// The points at which two solids touch, or might within `margin` [m]; none if they are farther apart. Both in the
/// frame of a, where b has a pose. Flat parts that nearly face each other touch in up to four points, round ones in
/// one. By `turning` [m] points may move against one another before contacts are found again: a coin that tips over
/// touches with both sides of its rim then.
Touch touch(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b, double margin, double turning = 0);

/// The same for a half-space y <= 0 (solid a, in its frame) and a convex solid b.
Touch touch_half_space(const ConvexShape& b, const Posed& pose_of_b, double margin, double turning = 0);

}  // namespace pliant
