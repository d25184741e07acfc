// Initial intersections of an object that is to be added to a World.
#pragma once

#include <cstdint>

#include "world/world_data.h"

namespace pliant {

/// Bit sets of collision groups: those that a body belongs to, and those that it meets.
struct Masks {
  std::uint32_t groups = 1, mask = ~0u;
};

/// Throws an Error if the settings refuse initial intersections and the object to be added has some.
void refuse_intersections(const WorldData& world, const CompiledObject& added, const Masks& masks, bool is_grid);

}  // namespace pliant
