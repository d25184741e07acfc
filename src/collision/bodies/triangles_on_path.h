// The points at which a solid that moves touches triangles: those of its first touch with each, or of where it passes
// nearest.
#pragma once

#include <vector>

#include "collision/bodies/triangle_contact.h"
#include "geometry/contact_path.h"

namespace pliant {

/// Replaces the points of triangles with which a contact that was found at the start of a path would stop a solid on
/// its path, although it passes, or in another direction than that of the touch. `near` are the triangles within reach.
/// Returns the first touch.
PathContact put_on_path(const SolidInMesh& solid, const BodyMesh& mesh, const std::vector<int>& near, double reach,
                        const SolidPath& on, std::vector<TrianglePoint>& points);

}  // namespace pliant
