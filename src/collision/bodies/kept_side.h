// Keeps two bodies on the sides of one another on which they were.
//
// A stick whose end is thrown at a thin wall may be found more than half through it, since contacts are linear between
// two searches. The least way out is then on the far side.
#pragma once

#include <span>

#include "collision/bodies/body_part.h"
#include "geometry/touch.h"
#include "pliant/state.h"

namespace pliant {

/// True if two convex parts that overlap now face the other way than in their contact before. Normals point from a to
/// b; that of `found` in the frame of body a, which has that pose.
bool has_changed_sides(const Touch& found, const Posed& a, std::span<const BodyContact> before);

/// Contact points of two convex parts along `normal`, a unit vector in the frame of body a: the one that is wider
/// across it counts as a half-space. They are within `margin` of it [m].
Touch touch_along(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Vec3d& normal, double margin,
                  double turning);

/// A triangle of a mesh that the centre of a solid has passed, and the side from which.
struct MeshSideKept {
  int triangle = -1;  ///< -1: it has passed none
  Vec3d normal{};     ///< unit vector to that side, in the frame of the mesh
};

/// The triangle through which the centre of a part b has gone since its contacts with a mesh were found, or before, if
/// it still is behind it. What has moved by more than `farthest` besides four times its size [m] has been put there.
MeshSideKept side_kept(const BodyMesh& mesh, const BodyPart& b, const Posed& b_in_mesh, double farthest,
                       std::span<const BodyContact> before);

}  // namespace pliant
