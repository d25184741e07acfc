// Contact of a convex solid with a mesh: manifolds of up to four points, one for each direction in which the mesh is touched.
#pragma once

#include <vector>

#include "collision/bodies/body_mesh.h"
#include "geometry/touch.h"

namespace pliant {

/// A manifold between a mesh, which is `a`, and a solid, which is `b`.
struct MeshTouch {
  /// The first of its triangles. Each belongs to one manifold only, so this tells manifolds of one solid apart. A solid that
  /// slides changes it; TouchPoint::feature names corners of the solid whatever triangle they touch.
  int piece = 0;
  Touch touch;  ///< in the frame of the mesh
};

/// Finds where a solid touches a mesh, or might within `reach` [m], sorted by pieces. Replaces `found`. Triangles whose normals
/// of contact differ by less than about six degrees share a manifold. `turning` as of SolidInMesh.
void touch_mesh(const ConvexShape& shape, const Posed& pose_in_mesh, const BodyMesh& mesh, double reach,
                std::vector<MeshTouch>& found, double turning = 0);

}  // namespace pliant
