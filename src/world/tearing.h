// Objects that tear and are cut while a World runs. Their descriptions are kept, because an edit needs them.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Keeps the description of an object that comes apart, or of any if the World keeps all; forgets that of others, and
/// of one that was removed (null).
void keep_description(WorldData& world, int slot, const Object* object);
void keep_description(WorldData& world, int slot, Object&& object);

/// Tears and cuts objects at the end of a step. What cannot be torn stays whole, and a warning says so.
void tear_objects(WorldData& world, Report& report);

}  // namespace pliant
