// Surfaces that start at distance 0 of one another, as cloth that is modelled exactly on a body: contact cannot tell on
// which side to keep them, so the side is chosen here.
//
// Each pair of touching surfaces has a fixed one: what never moves before what moves, closed surfaces before open ones,
// then the order of the scene. The other one moves to the side of the first one's normals, out to the distance that
// contact keeps. Where all of a touching patch that is not exactly on the other surface lies on its far side, the patch
// moves there instead, so that what hangs from a ceiling does not jump through it. Layers on layers move by the sum of
// their distances.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Moves particles that are within rounding of another surface that they meet, in the State: of all objects when a
/// World is made, else of the object that was added. What the objects are described as stays, and with it their rest
/// data. Contact keeps the full distance between what is described as touching (collision/narrow/contact_detector.cpp).
void part_touching_starts(WorldData& world, int number = -1);

}  // namespace pliant
