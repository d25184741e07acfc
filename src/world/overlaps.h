// Particles of liquids and gases that overlap others when they are placed: they separate at a limited speed
// (solver/fluids/fluid_overlaps.h).
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Marks the particles of a liquid or gas that overlap others of their kind, in a channel of the State, and has the
/// next step warn of them. `number` is that of an object that was added or edited; -1: all objects.
void mark_overlaps(WorldData& world, int number);

/// After a step: removes the channel if no particle overlaps any more.
void forget_overlaps(WorldData& world);

}  // namespace pliant
