// Contact of a convex solid with a mesh: manifolds of up to four points, one for each direction in which the mesh is
// touched.
#pragma once

#include <vector>

#include "collision/bodies/body_mesh.h"
#include "collision/bodies/kept_side.h"
#include "collision/bodies/triangles_on_path.h"
#include "geometry/touch.h"

namespace pliant {

/// A manifold between a mesh, which is `a`, and a solid, which is `b`.
struct MeshTouch {
  /// The first of its triangles. Each belongs to one manifold only, so this tells manifolds of one solid apart. A solid
  /// that slides changes it; TouchPoint::feature names corners of the solid whatever triangle they touch.
  int piece = 0;
  Touch touch;    ///< in the frame of the mesh, with the solid moved
  Vec3d moved{};  ///< from where the solid is to where it touches [m]
};

/// Finds where a solid touches a mesh, or might within `reach` [m], sorted by pieces. Replaces `found`. Triangles whose
/// normals of contact differ by less than about six degrees share a manifold. `turning` as of SolidInMesh. If the solid
/// moves along a path, the directions are those of the first touches on it; returns the first of them.
PathContact touch_mesh(const ConvexShape& shape, const Posed& pose_in_mesh, const BodyMesh& mesh, double reach,
                       std::vector<MeshTouch>& found, double turning = 0, const SolidPath* path = nullptr);

/// Where a solid touches the plane of a triangle that its centre has passed.
MeshTouch touch_side(const ConvexShape& shape, const Posed& pose_in_mesh, const BodyMesh& mesh,
                     const MeshSideKept& kept, double reach, double turning);

}  // namespace pliant
