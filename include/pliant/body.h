// Makes rigid bodies of solids. A body is a particle, which is its centre of mass, and a frame, which is its
// orientation, so constraints act on it like on any other (ObjectBody, ObjectFrame).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Mass and inertia that are known otherwise than from solids, in the frame in which these are described.
struct BodyInertia {
  float mass = 1;          ///< > 0 [kg]
  Vec3f centre{};          ///< centre of mass [m]
  Vec3f moments{1, 1, 1};  ///< Ixx, Iyy, Izz about the centre, > 0; none above the sum of the others [kg m^2]
  Vec3f products{0, 0,
                 0};  ///< Iyz, Izx, Ixy: elements of the inertia tensor, negative integrals of y z, z x, x y [kg m^2]
};

/// Options of make_body.
struct BodyOptions {
  std::string name = "body";  ///< the bodies of an object in a World have names of their own, or this default
  Vec3f position{};           ///< of the frame in which the solids are described [m]
  Quatf rotation{};           ///< of that frame; unit quaternion
  Vec3f velocity{};           ///< of the centre of mass [m/s]
  Vec3f angular_velocity{};   ///< in world axes [rad/s]
  float mass = 0;             ///< replaces the mass that densities give, > 0 [kg]; 0: by density; infinity: fixed
  /// Replaces mass, centre and inertia of the solids, of which there may then be none.
  std::optional<BodyInertia> inertia{};
  /// Infinite mass: nothing pushes or turns it; it follows `motion`, or ObjectHandle::set_pose.
  bool kinematic = false;
  Motion motion{};           ///< of a kinematic body: moves it from `position` and `rotation`, as Collider::motion does
  Vec3f surface_velocity{};  ///< ObjectBody::surface_velocity [m/s]
};

/// Makes an object of one rigid body of solids, which may overlap: each counts with its own mass. Its particle is the
/// centre of mass, its frame the principal axes of inertia. Throws an Error that names a solid with a size or density
/// that is not positive, a hull whose points lie in a plane, a rotation of zero, an inertia that no body has, or a
/// motion without `kinematic`. The object collides with others and, if bodies are added, with itself. A motion becomes
/// a Pin of the body's particle.
Object make_body(const std::vector<Solid>& solids, const BodyOptions& options = {});

/// Adds a rigid body to an object, for example to a pile or a mechanism, and returns its index in Object::bodies.
int add_body(Object& object, const std::vector<Solid>& solids, const BodyOptions& options = {});

/// Ties particles of the object to a body, each to the place where it is: the end of a rope, the corner of a cloth.
/// They do not touch that body. Throws an Error if there are no particles, or that names a particle or body that does
/// not exist. Append rope or cloth to the body's object first.
void attach(Object& object, const std::vector<int>& particles, int body, const Stiffness& stiffness = {});

/// Ties particles of the object to its own triangles, as buttons to a shirt: each to the nearest place on triangles
/// that do not have it as a corner. It is pulled onto that place. Throws an Error if there are no particles or
/// triangles, or that names a particle that does not exist. Append the shirt and the buttons to one object first.
void attach_to_surface(Object& object, const std::vector<int>& particles, const Stiffness& stiffness = {});

/// Ties particles of the object to its own tetrahedra (tetrahedra_of), as a tendon to flesh: each to the place where it
/// is, in the tetrahedron that it lies in, or the nearest one. Throws an Error as attach_to_surface does.
void attach_inside(Object& object, const std::vector<int>& particles, const Stiffness& stiffness = {});

/// Adds the particles, frames, bodies, joints, constraints, triangles and pins of another object to an object, whose
/// other properties stay. Bodies and joints whose names are taken get a number after them, as in "door_2". Returns the
/// index of its first particle. Throws an Error if it has a volume.
int append(Object& object, const Object& other);

/// The pose of a body at time 0: of the frame in which it was described (BodyOptions::position, rotation), in the
/// world.
RigidPose pose_of(const Object& object, int body);

/// Closed triangle meshes of all solids in one mesh, for pictures and files, in the frame in which the solids are
/// given. Round solids have `segments` (8..512) around their axis. Throws an Error if a hull's points lie in a plane.
TriangleMesh mesh_of(const std::vector<Solid>& solids, int segments = 32);

}  // namespace pliant
