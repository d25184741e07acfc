// Rigid bodies: what they are made of. A body is a particle, which is its centre of mass, and a frame, which is its orientation,
// so constraints act on it like on any other (ObjectFrame). Nothing touches bodies yet: contact of bodies is not part of a step.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

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

using SolidShape = std::variant<Sphere, Capsule, Box, Cylinder, Cone, Hull>;

/// A convex solid that is part of a body.
struct Solid {
  SolidShape shape;
  Vec3f position{};  ///< of the shape's frame in the frame in which the body is described [m]
  Quatf rotation{};
  float density = 1000;  ///< [kg/m^3]
};

/// Options of make_body.
struct BodyOptions {
  std::string name = "body";
  Vec3f position{};          ///< of the frame in which the solids are described [m]
  Quatf rotation{};          ///< of that frame; unit quaternion
  Vec3f velocity{};          ///< of the centre of mass [m/s]
  Vec3f angular_velocity{};  ///< in world axes [rad/s]
  float mass = 0;            ///< replaces the mass that densities give, > 0 [kg]; 0: by density
};

/// Makes a rigid body of solids, which may overlap: each counts with its own mass. Its one particle is the centre of mass, its
/// one frame the principal axes of inertia. Throws an Error that names a solid with a size or density that is not positive, or a
/// hull whose points lie in a plane.
Object make_body(const std::vector<Solid>& solids, const BodyOptions& options = {});

}  // namespace pliant
