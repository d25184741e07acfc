// Compiles distance constraints to paths, and tethers to pins: the data of the chain sweep.
#pragma once

#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

/// Marks the distances that chains solve: compliant and rigid ones with a positive rest
/// length. Attachments (rest length zero) have no direction to solve along, and damped and PBD
/// distances are no part of a linear system. Both go to separate lists and are swept as usual.
void split_off_chains(std::vector<ConstraintList>& lists);

/// Decomposes the marked lists into paths. The object's particles must be in storage order and its pools must exist.
void append_chains(const std::vector<ConstraintList>& lists, float softness, CompiledObject& out);

/// For each free particle: the geodesic distance along constraints and triangles to the nearest pin of each of the four
/// nearest groups of pins, times 1 + slack. Needs the surface.
Tethers find_tethers(const std::vector<ConstraintList>& lists, float slack, const CompiledObject& object);

}  // namespace pliant
