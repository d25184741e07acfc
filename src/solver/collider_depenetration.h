// Moves surfaces, ropes and soft bodies out of primitive colliders and distance grids in which they start, or into
// which they or the collider are teleported, along the way of ways_out.h.
//
// Planes and terrain have the same way out everywhere, to which contact leads at 2 m/s; mesh colliders are left to
// untangling. What has fixed particles inside is meant to be there.
//
// Whether something is deep inside depends on positions at the frame's start alone, so a State need not keep it, and a
// substep in which nothing is costs nothing.
#pragma once

#include "math/functions.h"
#include "solver/substep.h"

namespace pliant {

/// In the first substep of a frame, after colliders have been placed: finds Substep::ways_out, and warns of them.
void find_points_inside(Substep& s);

/// Replaces the contacts of a tile's points that are inside and move along a way out.
void follow_ways_out(const Substep& s, int task, std::vector<Contact>& contacts);

/// Removes the contacts of edges and triangles with colliders that have such a point.
void drop_elements_inside(const Substep& s, std::vector<Contact>& contacts);

/// After contacts have been found: notes the speeds of the objects that are led out of a collider or a body.
void note_speeds(Substep& s);

/// After respond: limits the speeds of these objects to 2 m/s more than the solid's, or to what they were. What leaves
/// a solid at different times in different places is stretched, and would be thrown. `missing` is the gravity that an
/// object's velocities do not include yet.
void limit_speeds(Substep& s, FunctionRef<Vec3f(int object)> missing);

}  // namespace pliant
