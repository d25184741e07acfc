// Limits on how far the edges of an object may stretch (StrainLimit).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pliant/object.h"

namespace pliant {

/// A group of constraints that keeps edges between the limits, each edge once; `edges` may repeat. Throws an Error if
/// the limits are out of range, with the object's name.
ConstraintGroup limit_edges(const std::vector<Vec3f>& positions, std::vector<std::array<int, 2>> edges,
                            const StrainLimit& limit, const std::string& object);

}  // namespace pliant
