// Storage order for meshes without grid lines, so that groups of four constraints still use contiguous particles.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// Returns the storage order: order[new] = old, tile after tile. A tile is cut into four equal patches, numbered in the
/// same order of growth: their t-th particles are contiguous, patch 0 first, from a multiple of four. A patch's surplus
/// comes before and after. `links` are pairs of particles that share a constraint; duplicates are allowed.
///
/// Why: if the t-th particle of every patch is linked to the s-th, the four constraints access contiguous groups of four
/// records, as four edges of a grid do. Each new group is chosen to have as many such links as possible.
std::vector<int> number_in_lockstep(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                                    const std::vector<std::array<int, 2>>& links);

}  // namespace pliant
