// Rods that tear and are cut: their joints break, and nothing is compiled again.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Breaks the joints of an object's rods that blades have passed by now, if it is being cut, and of each rod the one
/// that is stretched farthest, if that is too far. Tells in the Report.
void tear_rods(WorldData& world, ObjectId id, const Object& object, bool is_being_cut, Report& report);

}  // namespace pliant
