// Shapes of solids, for colliders and for rigid bodies.
#pragma once

#include <variant>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

struct Plane {};  ///< solid is the half-space y <= 0 of its frame
struct Sphere {
  float radius = 0.5f;
};  ///< a solid ball of this radius [m]
struct Capsule {
  float radius = 0.25f, half_length = 0.5f;
};  ///< a solid capsule along the y-axis of its frame; half_length excludes the caps [m]
struct Box {
  Vec3f half_extents{0.5f, 0.5f, 0.5f};
};  ///< a solid box; half_extents are half its edge lengths [m]

/// A solid cylinder along the y-axis of its frame, about its middle [m].
struct Cylinder {
  float radius = 0.25f, half_length = 0.5f;
};

/// A solid cone along y: its base at -half_length, its apex at +half_length [m].
struct Cone {
  float radius = 0.25f, half_length = 0.5f;
};

/// The convex hull of points, for example of a mesh's vertices, grown by a margin [m].
struct Hull {
  std::vector<Vec3f> points;
  float margin = 0;
};

/// The shape of a primitive collider.
using Shape = std::variant<Plane, Sphere, Capsule, Box>;

/// The shape of a convex solid that is part of a rigid body.
using SolidShape = std::variant<Sphere, Capsule, Box, Cylinder, Cone, Hull>;

/// A convex solid that is part of a rigid body.
struct Solid {
  SolidShape shape;
  Vec3f position{};  ///< of the shape's frame in the frame in which the body is described [m]
  Quatf rotation{};
  float density = 1000;  ///< [kg/m^3]
};

}  // namespace pliant
