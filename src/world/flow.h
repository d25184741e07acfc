// Particles that come and go between steps: their lifetime ends, drains take them, emitters add them.
#pragma once

#include "pliant/report.h"
#include "world/world_data.h"

namespace pliant {

/// Removes and adds particles for a step that begins now, and counts them.
void let_flow(WorldData& world, double dt, FlowReport& report);

/// The particles that are there, of objects whose particles come or go.
std::int64_t count_present(const WorldData& world);

}  // namespace pliant
