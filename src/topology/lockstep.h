// Storage order for meshes without grid lines, in which groups of four constraints still use contiguous particles.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// Returns the storage order: order[new] = old, tile after tile. A tile is divided into four equal patches, numbered
/// in the same order of growth: their t-th particles are contiguous, that of patch 0 first, at a multiple of four.
/// Surplus particles of a patch come first or last. `links` are pairs of particles that share a constraint
/// (duplicates allowed). If the t-th particle of every patch is linked to the s-th, the four constraints use
/// contiguous groups of four records, like four edges of a grid. Each new group is chosen to have as many such links
/// as possible.
std::vector<int> number_in_lockstep(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                                    const std::vector<std::array<int, 2>>& links);

}  // namespace pliant
