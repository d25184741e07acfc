// The substep groups of a World: when they are made again, and with how many substeps each goes through a frame.
#pragma once

#include <vector>

#include "world/world_data.h"

namespace pliant {

/// Notes for bring_up_to_date() that an object was added, removed or edited, if its surface can touch something.
void note_surfaces(WorldData& world, int number);
/// Does what additions, removals and edits since the last step require; call it before a step.
void bring_up_to_date(WorldData& world);

/// Makes the groups again where objects have come near or gone away since the last frame. Call it after the user's
/// control has begun, before plan_frame().
void follow_distances(WorldData& world, double dt);

/// The substeps per frame of an object as planned; 0: they follow the State.
int substeps_of(const WorldData& world, int number);
/// The substeps of each group in the next frame of `dt` seconds, which fast colliders can increase. Adds warnings to
/// the Report.
std::vector<GroupFrame> plan_frame(const WorldData& world, double dt, Report& report);

}  // namespace pliant
