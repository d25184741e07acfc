// Surface velocities that the user sets between steps. The State keeps them until the next call.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Gives the step the surface velocities of the State. Call it at a step's start.
void begin_surface_velocities(WorldData& world);

/// Throws an Error if a State has a surface velocity of what this World does not have, or one that is no velocity.
void require_surface_velocities(const WorldData& world, const State& given);

/// Discards what was set for something that is removed. `slot` and `body` as in SurfaceVelocity.
void forget_surface_velocities(WorldData& world, SurfaceVelocity::Of of, int slot);

}  // namespace pliant
