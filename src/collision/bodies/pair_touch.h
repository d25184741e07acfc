// Where two convex parts of bodies touch, or might within a frame.
#pragma once

#include "collision/bodies/body_part.h"
#include "collision/bodies/round_contact.h"
#include "geometry/contact_path.h"
#include "geometry/touch.h"

namespace pliant {

/// How far points move until contacts are found again [m].
struct Reach {
  double margin = 0, turning = 0;
  Rocking rocking{};
};

/// Contact points in the frame of body a.
struct PairTouch {
  Touch touch;              ///< with b moved
  Vec3d moved{};            ///< from where b is to where it touches [m]
  PathContact first;        ///< the first touch on the path of b, if it touches
  bool is_stopped = false;  ///< the contact as both are now would stop b on its path
};

/// The pose of b in the frame of a, whose rotation is a unit quaternion up to rounding.
Posed relative_to(const Posed& a, const Posed& b);

/// Contact points of two parts, or of a half-space and a part, as they are now.
Touch touch_of(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Reach& reach);

/// The same for a part b that moves along a path in the frame of body a. `now` is the contact as they are now; where it
/// would stop b on its path, the contact is that of the first touch, or of the place where both pass nearest.
PairTouch touch_on_path(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Reach& reach, const Touch& now,
                        const SolidPath& on);

/// When b, on its path, first touches a half-space with which it has the contact `now`.
PathContact first_on_plane(const Touch& now, const SolidPath& on);

}  // namespace pliant
