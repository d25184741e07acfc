// What comes and goes between steps: particles whose lifetime ends, that drains take and emitters add; gas in volumes.
#pragma once

#include "pliant/report.h"
#include "world/world_data.h"

namespace pliant {

/// Removes and adds particles for a step that begins now, and counts them.
void let_flow(WorldData& world, double dt, FlowReport& report);

/// Sets the volumes whose pressure changes to their targets at a time [s].
void follow_pressures(WorldData& world, double time);

/// The particles that are there, of objects whose particles come or go.
std::int64_t count_present(const WorldData& world);

}  // namespace pliant
