// Which places lie in what is solid in a scene.
#pragma once

#include <vector>

#include "pliant/liquid.h"

namespace pliant {

/// Whether mesh colliders and closed surfaces are asked, which takes time to prepare, or primitive colliders and bodies
/// alone.
enum class MeshesToo { yes, no };

/// What leave_out_solids would leave out of the places.
std::vector<PlacesInSolid> find_in_solids(const std::vector<Vec3f>& places, const Scene& scene,
                                          const LeaveOutOptions& options, MeshesToo meshes);

}  // namespace pliant
