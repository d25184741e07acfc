// Where a convex solid touches one triangle of a mesh.
//
// The direction of contact is that of least overlap, or of the distance. If it lies outside the mesh's normal cone at
// the triangle's edge or corner, some other triangle is nearer, and this one takes its own normal: so inner edges of a
// flat mesh give no other normals than its faces.
#pragma once

#include <vector>

#include "collision/bodies/body_mesh.h"
#include "collision/bodies/solid_in_mesh.h"
#include "collision/bodies/triangle_nearest.h"
#include "geometry/touch.h"

namespace pliant {

/// A point of contact with a triangle. `a` of the touch point is the mesh, and normals point to the solid.
struct TrianglePoint {
  int triangle = 0;
  Vec3d normal{};
  TouchPoint point;
  Vec3d moved{};  ///< from where the solid is to where it touches [m]
};

/// Appends the points at which a solid touches a triangle, or might within `reach` [m]. They share a normal.
void touch_triangle(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                    std::vector<TrianglePoint>& points);

/// The same where the nearest places are known.
void touch_triangle(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                    const TriangleNearest& nearest, std::vector<TrianglePoint>& points);

/// True if a triangle holds what passes it along a normal, in that direction or, if it is smooth, in its own.
bool has_direction(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal);

/// The direction in which a triangle holds a solid to which it is nearest along `normal`: that, or its own normal where
/// another triangle is nearer in that direction.
Vec3d direction_of_contact(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal);

/// Appends the points of a solid that are deepest below the plane of a triangle, as if that had no bounds. `normal` is
/// that of the triangle, or its opposite: to the side to which the solid belongs.
void touch_plane_of(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal, double reach,
                    std::vector<TrianglePoint>& points);

/// Appends the points on the plane of a triangle that a solid is about to reach across a valley: one that overlaps the
/// triangle before the valley touches the edge between them before it is over the triangle beyond.
void touch_beyond_valley(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                         std::vector<TrianglePoint>& points);

/// The triangle out of which the way along its normal is shortest, of those that a solid overlaps; -1: it overlaps
/// none.
int least_overlapped(const SolidInMesh& solid, const BodyMesh& mesh, const std::vector<int>& triangles);

}  // namespace pliant
