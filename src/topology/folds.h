// Edges at which a surface is folded back on itself.
#pragma once

#include <vector>

#include "math/vector.h"
#include "topology/edges.h"

namespace pliant {

/// The indices of the inner edges whose two triangles lie on one another: the angle between them is below one degree.
/// Triangles without area are left out.
std::vector<int> folded_edges(const std::vector<Vec3f>& positions, const std::vector<Edge>& edges);

}  // namespace pliant
