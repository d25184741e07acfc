// The surface of soft bodies that come apart.
#pragma once

#include <array>
#include <vector>

#include "matter/part_solid.h"

namespace pliant {

/// The triangles of an object whose tetrahedra get the corners `after`, at these positions of particles: first those
/// that are of no tetrahedron, as of cloth, then border_triangles of all tetrahedra that stay. Throws an Error as
/// border_triangles does.
std::vector<std::array<int, 3>> surface_after(const Object& object, const SolidParting& parting,
                                              const std::vector<std::array<int, 4>>& after,
                                              const std::vector<Vec3f>& positions);

}  // namespace pliant
