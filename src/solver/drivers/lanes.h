// The drivers of constraints that are projected in SIMD lanes: inside tiles, and between tiles.
#pragma once

#include "solver/drivers/driver.h"

namespace pliant {

/// Projects the constraints inside a tile once.
void project_tile(const Substep& s, int task, bool first_pass, Order order);

/// Calls body(object, segment) for every segment of inter-tile constraints, in the order of colours.
void for_inter_tile(Substep& s, FunctionRef<void(int, const Segment*)> body);

}  // namespace pliant
