// Surfaces that start at distance 0 of one another, as cloth that is modelled exactly on a body: contact cannot tell on which
// side to keep them, so the side is chosen here.
//
// Each pair of touching surfaces has a fixed one: what never moves before what moves, closed surfaces before open ones, then the
// order of the scene. The other one moves to the side of the first one's normals, out to the distance that contact keeps. Where
// all of a touching patch that is not exactly on the other surface lies on its far side, the patch moves there instead, so that
// what hangs from a ceiling does not jump through it. Layers on layers move by the sum of their distances.
#pragma once

#include <vector>

#include "model/model.h"

namespace pliant {

/// Moves the initial positions of objects that start within rounding of another surface that they meet. Call it when all objects
/// of a scene are compiled, before the State is made: rest data of constraints stay, the distances at rest by which contact is
/// limited follow. The result depends on the start alone.
void part_touching_starts(Model& model);

/// Moves the initial positions of an object that replaces another one as that one's were moved. `origins` lists for each of its
/// particles the one of the old object, or -1, both in storage order.
void keep_shifts(const CompiledObject& old, const std::vector<int>& origins, CompiledObject& by);

}  // namespace pliant
