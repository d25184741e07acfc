// What truncated steps leave of velocities. The filter moves vertices less far than the solver wanted, so that nothing
// crosses; their velocities are those that the solver gave them, less what equal and opposite impulses along the lines
// between closest points end of the approach of filtered pairs. So linear and angular momentum are kept and energy does
// not grow, however few sweeps there are.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "collision/filter/plane_filter.h"

namespace pliant {

/// A vertex and a displacement of it [m].
using VertexDisplacement = std::pair<std::int32_t, Vec3f>;

/// Finds displacements that are to become velocities in place of the present ones. `before`: of vertices whose steps
/// were truncated, the displacements before that. `slabs`: of pairs in which a step was; both in any order, and may be
/// named several times: the first displacement of a vertex counts. Appends to `without_velocity` what is not to become
/// velocity of the present displacements. The order that decides bits, and that of the result, is by bodies, then by
/// vertices. `body`: of each vertex.
void keep_momentum(std::vector<VertexDisplacement>& before, std::vector<SeparatingSlab>& slabs,
                   const std::vector<int>& body, const Record* positions, const Record* displacements,
                   std::vector<VertexDisplacement>& without_velocity);

}  // namespace pliant
