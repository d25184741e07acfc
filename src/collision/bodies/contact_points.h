// The points of a contact between parts of bodies, and what they keep from frame to frame.
#pragma once

#include "geometry/touch.h"
#include "math/quat.h"
#include "pliant/state.h"

namespace pliant {

/// Places the points of a new contact, which b touches when it has moved by so much in the frame of a [m].
void set_points(const Touch& found, const Vec3d& moved, const Posed& a, const Posed& b, BodyContact& c);

/// The gaps along the normal, for bodies that have moved since the contact was found.
void renew_gaps(const Posed& a, const Posed& b, BodyContact& c);

/// Hands the impulses of an earlier contact of the same parts to the points that are the same.
void take_impulses(const BodyContact& old, BodyContact& c);

}  // namespace pliant
