// Objects on which nothing fixed acts in a substep: what keeps them apart may not change their momentum.
#pragma once

#include "collision/filter/filter_frames.h"
#include "collision/narrow/contact.h"

namespace pliant {

struct Substep;

/// Finds them after the solve, by what touches, where it is asked for first in a substep: only what truncates steps
/// needs it. An object is not free if it has particles of zero inverse mass, touches a collider, has rigid bodies that
/// touch others, or touches an object that is not free.
const FreeBodies& free_objects(Substep& s);

/// True if an object is free.
bool is_free(Substep& s, int object);

/// The least distance of a box of an object's particles from a solid in the substep [m]; infinite where they do not
/// meet.
float distance_from_solid(const CompiledObject& object, const PointBounds& box, const MovingCollider& solid);

/// Before the update: takes what is not to become velocity out of the displacements of this substep.
void take_from_velocities(Substep& s);

}  // namespace pliant
