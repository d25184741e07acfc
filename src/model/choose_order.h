// Chooses the storage order of an object's particles.
#pragma once

#include <vector>

#include "model/gather_constraints.h"
#include "pliant/vec3.h"

namespace pliant {

/// Returns order[storage] = user index, tile by tile. Within a tile it uses the order that puts more constrained pairs
/// into contiguous groups: chains (topology/numbering.h), for grid-like input, or lockstep (topology/lockstep.h).
std::vector<int> choose_order(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                              const std::vector<ConstraintList>& lists);

}  // namespace pliant
