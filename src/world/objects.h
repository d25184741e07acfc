// Changes of objects that World and its stages make.
#pragma once

#include <vector>

#include "world/world_data.h"

namespace pliant {

/// As World::edit. It forgets what the user set for the object.
std::vector<int> edit_object(WorldData& world, ObjectId object, const Edit& edit);
/// Does the same, and takes the description from the edit.
void edit_object(WorldData& world, ObjectId object, Edit&& edit);

}  // namespace pliant
