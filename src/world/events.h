// Contact events of a World.
#pragma once

#include "world/world_data.h"

namespace pliant {

/// Makes the contact events of the last step from Workspace::contact_log.
void make_events(WorldData& world);
/// Removes the contacts of a thing that is removed. It gets no end event, because its id is no longer valid.
void forget_touching(WorldData& world, const Thing& thing);

}  // namespace pliant
