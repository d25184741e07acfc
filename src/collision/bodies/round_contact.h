// Contact of a flat part of one solid with a large round one, as of a box that lies on a sphere.
//
// Both touch in one point. Where the flat part rocks by an angle, that point moves over it by the radius R times the
// angle. Contacts keep their points for a frame, so the restoring moment comes late: omega^2 = g R / k^2 with the
// radius of gyration k about the point, and for omega dt > 1 the box rocks farther in each frame than in the one
// before, and turns through the surface. So a flat part that may rock from one side to the other within a frame touches
// with its corners instead.
#pragma once

#include "collision/bodies/body_part.h"
#include "geometry/touch.h"

namespace pliant {

/// What limits the points of a flat part on a round one.
struct Rocking {
  double height = 0;  ///< of points above the surface, at most [m]
  /// Angle that half of the flat part covers, seen from the centre of a round solid a, at most; 0: b does not rock.
  double on_a = 0;
  double on_b = 0;     ///< the same of a round solid b
  double turning = 0;  ///< angle by which the round solid turns under the flat one [rad]
};

/// For bodies a and b in a frame of `dt` seconds in which gravity adds `faster` [m/s] to speeds.
Rocking rocking_of(const BodyState& a, const BodyState& b, float dt, float faster);

/// The contact `found` of solids in the frame of a, where b has a pose; or that of the corners of a flat part on a
/// round one if it may rock. All points are lowered by the height of the lowest above the nearest point: else the flat
/// part would sink in until corners carry it.
Touch with_corners(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b, const Touch& found,
                   const Rocking& rocking);

}  // namespace pliant
