// Cutting an object into tiles: sets of particles close to one another, each small enough for a core's own cache.
#pragma once

#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// The tile of every particle, tiles numbered 0, 1, ... along the cuts. Halves the particles along the longest side of their
/// box, ties by index, until no tile holds more than `largest` (>= 1): depends on the positions alone.
std::vector<int> cut_into_tiles(const std::vector<Vec3f>& positions, int largest);

}  // namespace pliant
