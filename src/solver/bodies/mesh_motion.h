// How a mesh that deforms moves where a body touches it, from the velocities of its vertices.
#pragma once

#include <vector>

#include "collision/bodies/body_mesh.h"
#include "pliant/state.h"

namespace pliant {

/// The rigid motion that comes nearest to that of a surface at the points of a contact.
struct SurfaceMotion {
  Vec3f velocity{};  ///< of the centre of the points (BodyContact::x, y) [m/s]
  Vec3f spin{};      ///< [rad/s]
};

/// The motion of a mesh at a contact of which it is `a`. At each point it is that of the nearest triangle, by its
/// barycentric coordinates. `triangles` are those of the mesh, `velocities` those of its vertices [m/s].
SurfaceMotion motion_of_mesh(const BodyContact& contact, const BodyMesh& mesh, const std::vector<Triangle>& triangles,
                             const std::vector<Vec3f>& velocities);

}  // namespace pliant
