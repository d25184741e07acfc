// Things that the user displaces by targets or poses, so far in one frame that they should be teleported.
//
// A jump is a displacement that differs by more than four times the thing's size, and a thousand times the largest
// thickness, from where its velocity leads. As motion it would stretch what hangs on it over the whole way, and bring
// nearly all pairs of primitives together: a frame of a cape of 560 particles took 44 s.
#pragma once

#include <string>
#include <vector>

#include "world/world_data.h"

namespace pliant {

/// Places at once what jumps in the frame of `dt` seconds that begins now, without velocity from the jump, and warns of
/// it. Things that jump alike are placed alike. An object whose pins do not all move alike stays, and is warned of.
/// Call it after begin_control().
void place_what_jumps(WorldData& world, double dt, std::vector<std::string>& warnings);

}  // namespace pliant
