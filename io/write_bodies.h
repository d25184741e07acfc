// Rigid bodies as writers see them.
#pragma once

#include <vector>

#include "write_frames.h"

namespace pliant::output {

/// Adds the bodies of an object, and the surfaces that they share.
void describe_bodies(const Object& object, FrameObject& result);

/// For each particle, whether it is the centre of a body.
std::vector<bool> body_centres(const Object& object);

/// A surface with normals: vertices occur several times where its edges are sharp.
struct ShadedMesh {
  std::vector<Vec3f> positions, normals;
  std::vector<std::array<int, 3>> triangles;
};

/// Gives each corner of a triangle the mean normal of the adjacent triangles that meet its own at less than 37 degrees.
ShadedMesh shaded(const TriangleMesh& mesh);

/// v rotated by a quaternion that is a unit one up to rounding.
Vec3f turned(const Quatf& q, const Vec3f& v);

}  // namespace pliant::output
