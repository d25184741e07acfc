// The direction in which a convex solid is nearest to a triangle, or overlaps it least.
#pragma once

#include "collision/bodies/body_mesh.h"
#include "collision/bodies/solid_in_mesh.h"

namespace pliant {

/// The nearest places of a triangle and the core of a solid, without the solid's radius.
struct TriangleNearest {
  bool is_near = false;             ///< false: farther apart than asked for; the rest is not set
  Vec3d normal{};                   ///< unit vector from the triangle to the solid
  double separation = 0;            ///< along it; negative: how far they must be moved apart [m]
  Vec3d on_triangle{}, on_solid{};  ///< on_solid - on_triangle is about separation x normal [m]
};

/// The nearest places, if the core is within `reach` of the triangle [m]. Polyhedra that overlap it are moved apart
/// along a normal of either or across an edge of each, others by convex_distance.
TriangleNearest nearest_on(const MeshFace& face, const SolidInMesh& solid, double reach, bool is_one_sided);

/// The same by supports alone, however far apart they are, and with no direction preferred; for a solid that is
/// displaced [m].
TriangleNearest exactly_nearest_on(const MeshFace& face, const SolidInMesh& solid, const Vec3d& displacement);

/// The triangle's normal on the side of a point; that by its winding if it has one side.
Vec3d facing_normal(const MeshFace& face, const Vec3d& point, bool is_one_sided);

}  // namespace pliant
