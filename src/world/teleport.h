// Moves an object or mesh collider to another place between steps.
#pragma once

#include "math/quat.h"
#include "world/world_data.h"

namespace pliant {

/// Moves all particles of an object or mesh collider rigidly, turns their velocities, and forgets what contact knows of
/// it. Targets that the user has set are reached from the new place. Call bring_up_to_date() before the next step.
void displace(WorldData& world, int number, const Posed& motion);

}  // namespace pliant
