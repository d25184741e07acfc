// In which order an object's particles are stored.
#pragma once

#include <vector>

#include "model/gather_constraints.h"
#include "pliant/vec3.h"

namespace pliant {

/// order[storage] = the user's number: tile after tile, inside a tile by the numbering that brings more pairs of constrained particles
/// into runs: chains (topology/numbering.h), which fit whatever is numbered in lines, or lockstep (topology/lockstep.h).
std::vector<int> choose_order(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                              const std::vector<ConstraintList>& lists);

}  // namespace pliant
