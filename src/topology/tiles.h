// Divides an object into tiles: compact sets of particles, each small enough for one core's cache.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// Returns the tile of every particle; tiles are numbered 0, 1, ... as they are cut. Bisects along the longest side of
/// the bounding box, ties by index, until no tile has over `largest` (>= 1) particles. Depends on positions alone.
std::vector<int> cut_into_tiles(const std::vector<Vec3f>& positions, int largest);

}  // namespace pliant
