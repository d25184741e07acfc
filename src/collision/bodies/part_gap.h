// Lower bounds of the distance of two parts, by a ball around one of them: most parts whose boxes overlap are apart,
// and a few products tell.
#pragma once

#include "collision/bodies/body_part.h"

namespace pliant {

/// A ball that has a part in it.
struct PartBall {
  Vec3d centre{};     ///< in the frame of the part's body
  double radius = 0;  ///< [m]
};

/// The ball about the middle of a convex part.
PartBall ball_around(const BodyPart& part);

/// True if the ball around b is more than `reach` [m] away from a. `centre` is that of the ball in the frame of body a.
/// Then touch() finds nothing within `reach`.
bool is_beyond(const BodyPart& a, const Vec3d& centre, double radius, double reach);

}  // namespace pliant
