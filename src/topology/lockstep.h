// Numbering the particles of a mesh that has no lines in it, so that fours of its constraints still use fours of particles.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// The order in which particles are stored: order[new] = old. Tile after tile; a tile is cut into four patches of equal size, which grow
/// in step: the particles that are t-th in each follow one another, patch 0's first, and begin at a multiple of four. What one patch has
/// more than another comes before and after. `links` are pairs of particles that share a constraint, in any order, more than once or not.
///
/// Why: where the t-th particle of each patch is linked to the s-th, the four constraints read and write fours of records that
/// follow one another, like four edges of a grid. Each next four is chosen to have as many such links as can be.
std::vector<int> number_in_lockstep(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                                    const std::vector<std::array<int, 2>>& links);

}  // namespace pliant
