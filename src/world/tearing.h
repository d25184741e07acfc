// Objects that tear and are cut while a World runs. Their descriptions are kept, because an edit needs them.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// True if a World changes the object itself: it tears, or cuts are to be made.
inline bool is_torn_by_world(const Object& object) { return object.tearing.has_value() || !object.cuts.empty(); }

/// Keeps the description of an object that tears or is cut; forgets that of others, and of one that was removed (null).
void keep_description(WorldData& world, int slot, const Object* object);

/// Tears and cuts objects at the end of a step. What cannot be torn stays whole, and a warning says so.
void tear_objects(WorldData& world, Report& report);

}  // namespace pliant
