// Handles of what is in a World, to read and control it between steps: World::object(id).positions().
//
// A view reads, a handle reads and controls. Both are small values: an id and a pointer to the World's data. They stay
// valid if the World is moved to another, and end when it is destroyed or another is assigned to it. All functions
// throw an Error if the thing was removed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/motion.h"
#include "pliant/state.h"

namespace pliant {

struct WorldData;

/// Facts about an object of a World.
struct ObjectInfo {
  std::string name;
  int particles = 0;
  /// Number of constraints of each type, "volume" included.
  std::vector<std::pair<std::string, std::int64_t>> constraints;
  /// Substeps per frame; 0: they follow the State. Fast colliders may increase them (Report::substeps)
  int substeps = 0;
};

/// What a joint does to its body b, in world axes.
struct JointLoad {
  Vec3f force{};   ///< [N]
  Vec3f torque{};  ///< about the joint's anchor [N m]
};

/// Where the two bodies of a joint are to one another. Axes are those of the joint, fixed in body a: x along the axis
/// of a hinge, slider or cylindrical joint, along `axis` of a ball joint, `axis_a` of a universal joint, and the normal
/// of a planar joint. Everything is 0 at time 0.
struct JointState {
  Vec3f displacement{};      ///< of b's anchor from its place in a [m]
  Vec3f rotation{};          ///< of b, as a vector along its axis whose length is the angle, up to half a turn [rad]
  Vec3f velocity{};          ///< of b's anchor, as seen from a [m/s]
  Vec3f angular_velocity{};  ///< of b against a [rad/s]
};

/// What a motor of a joint is to do.
struct MotorCommand {
  /// An angle [rad], displacement [m], speed [rad/s or m/s], torque [N m] or force [N], as the motor's kind says.
  float target = 0;
  std::optional<float> most{};  ///< greatest torque [N m] or force [N], > 0; left out: as before. Not of a torque motor
  std::string motor{};          ///< its name in ObjectJoint::motors; may be empty if the joint has only one
};

/// Reads an object.
class ObjectView {
 public:
  ObjectView(const WorldData& world, ObjectId id) : read_(&world), id_(id) {}
  ObjectId id() const { return id_; }
  ObjectInfo info() const;
  /// Of info(), without allocation. The name is valid until something is added, removed or edited.
  const std::string& name() const;
  int particle_count() const;
  /// The present description of an object with Object::tearing or cuts, which the World changes as it tears; the scene
  /// to save the World with needs it. Throws an Error for other objects, unless the World was made with
  /// KeepDescription.
  const Object& description() const;

  /// The positions of the particles in the user's order [m].
  std::vector<Vec3f> positions() const;
  std::vector<Vec3f> velocities() const;  ///< in the user's order [m/s]
  /// A channel of the State, as "temperature" of a gas: the values of the particles in the user's order. Empty if there
  /// is none.
  std::vector<float> channel(const std::string& name) const;
  /// The particles that are there, ascending: all, unless particles of the object come and go (Flow). Others have the
  /// place at which they went, or will not be seen before they are emitted.
  std::vector<int> present() const;
  std::vector<Vec3f> present_positions() const;  ///< of these [m]
  bool flows() const;                            ///< true if particles of the object come and go
  /// For how long each particle has been there [s]; negative: it has not left its opening yet, or (-1) is not there.
  std::vector<double> ages() const;
  /// The orientations of the frames, in the order of Object::frames.
  std::vector<Quatf> orientations() const;
  std::vector<Vec3f> angular_velocities() const;  ///< in world axes, in the order of Object::frames [rad/s]
  TriangleMesh mesh() const;                      ///< the surface at its present positions
  double enclosed_volume() const;                 ///< volume enclosed by the triangles [m^3]

  /// Copies positions into the caller's memory, one for each particle. Throws an Error if the size differs.
  void read_positions(std::span<Vec3f> into) const;
  void read_velocities(std::span<Vec3f> into) const;

  /// Spans of the particles in storage order: positions with the inverse mass as w, and velocities with w zero. They
  /// are valid until the next step or change. Record i is particle storage_order()[i]; indices beyond the object's own
  /// particles are targets of attachments.
  std::span<const Record> positions_in_storage_order() const;
  std::span<const Record> velocities_in_storage_order() const;
  std::span<const int> storage_order() const;

  /// The multipliers of the last substep in the order of the object's constraint groups of that type, row by row; empty
  /// if they were not stored: those of compliant distances always are, others if Settings::record_multipliers is set.
  /// The force is lambda / h^2 along the gradient (XPBD, eq. 17).
  std::vector<float> multipliers(const std::string& type) const;

  /// The load that a joint carried in the last substep; zero before the first step and for a broken joint. `joint` is
  /// an index in Object::joints.
  JointLoad joint_load(int joint) const;
  bool joint_is_broken(int joint) const;
  /// The mean of the load that a joint carried in the last frame in which it was solved, over the frame's substeps:
  /// that of one substep oscillates. Throws an Error unless World::record_joint_loads is on. Zero before the first
  /// step, and after the object was edited, torn or cut.
  JointLoad mean_joint_load(int joint) const;
  /// Angles, displacements and speeds of a joint, as they are now; of a broken one, too.
  JointState joint_state(int joint) const;
  /// The index in Object::joints of the only joint of that name. Throws an Error if there is none, or if there are
  /// several.
  int joint_index(const std::string& name) const;
  /// The present pose of a rigid body: of the frame in which it was described (BodyOptions::position, rotation), in the
  /// world. `body` is an index in Object::bodies, or a name that only one of these has. Throws an Error if there is no
  /// such body.
  RigidPose pose(int body) const;
  RigidPose pose(const std::string& body) const;
  /// True if a rigid body sleeps (SleepOptions). `body` is an index in Object::bodies.
  bool body_is_asleep(int body) const;

 private:
  const WorldData* read_;
  ObjectId id_;
};

/// Reads and controls an object, between steps. Calls with wrong sizes or values that are not finite throw an Error
/// that names object and element, and change nothing; so do targets and poses of bodies more than 1e9 m from the
/// origin, and two targets of one particle in a call.
class ObjectHandle : public ObjectView {
 public:
  ObjectHandle(WorldData& world, ObjectId id) : ObjectView(world, id), world_(&world) {}

  /// Moves kinematic particles (pins, infinite mass) at constant velocity to `positions` [m], which they reach at the
  /// end of the next step. After that they stay, or follow their keyframes, if any.
  void set_targets(std::span<const int> particles, std::span<const Vec3f> positions);
  /// Moves the targets of attachments in the same way. `attachments` are indices in the Object.
  void set_attachment_targets(std::span<const int> attachments, std::span<const Vec3f> positions);
  /// Moves the whole object at once, with all that its description joins: particles, pins, targets of attachments,
  /// bodies. A point p gets to by.rotation p + by.position, in world axes. Velocities turn with it and get nothing from
  /// the move; contacts are searched again, and all that sleeps wakes. Targets set for the next step stay where they
  /// are, and are reached from the new place. Throws an Error if the motion is not finite, or that names what would
  /// stay behind: a pin or attachment with keyframes, a joint to the world, an emitter.
  void teleport(const RigidPose& by);
  /// Moves a kinematic body (BodyOptions::kinematic, or infinite mass and inertia) to a pose [m] that it reaches at the
  /// end of the next step: of the frame in which it was described, as ObjectView::pose. Its centre of mass moves at
  /// constant velocity, and it turns along the shorter arc. After that it stays, or follows its keyframes, if any.
  /// `body` is an index in Object::bodies, or a name that only one of these has. Throws an Error if there is no such
  /// body, it is dynamic, or the pose is not finite or has a rotation of zero.
  void set_pose(int body, const RigidPose& pose);
  void set_pose(const std::string& body, const RigidPose& pose);
  /// Gives the surface of a body another surface velocity (ObjectBody::surface_velocity), in the frame in which the
  /// body was described [m/s]. It keeps it until the next call, restore() or edit. `body` as in set_pose. Throws an
  /// Error if there is no such body, or the velocity is not finite or above 1e6 m/s.
  void set_surface_velocity(int body, const Vec3f& velocity);
  void set_surface_velocity(const std::string& body, const Vec3f& velocity);
  /// Sets the velocity of each particle [m/s]; those of infinite mass are skipped.
  void set_velocities(std::span<const Vec3f> velocities);
  /// Adds an impulse to each particle [N s]: velocity += impulse / mass.
  void add_impulses(std::span<const Vec3f> impulses);
  /// Applies a constant force to each particle during the next step [N]. Replaces the forces of an earlier call.
  void set_forces(std::span<const Vec3f> forces);
  /// Pulls particles towards places during the next step, as springs with critical damping and these angular
  /// frequencies [1/s] would that have each particle's mass; those of infinite mass are skipped. Any frequency >= 0 is
  /// stable. Replaces what an earlier call gave the object.
  void set_pulls(std::span<const int> particles, std::span<const Vec3f> places, std::span<const float> frequencies);
  /// Gives a motor of the joint of that name a new target, which it keeps until the next call, restore() or edit. The
  /// kind of the motor stays. Throws an Error if the object has no such joint, or the joint no such motor.
  void set_motor(const std::string& joint, const MotorCommand& command);
  /// Multiplies the rest data of a group of constraints by a factor >= 0 instead of its keyframes, until the next call,
  /// restore() or edit: rest lengths of "distance", rest volumes of "tetrahedron_volume", the rest stretch of "fibre"
  /// (a muscle's activation). `group` is an index in Object::constraints. Throws an Error if there is no such group, or
  /// its type has no size at rest.
  void set_rest_factor(int group, float factor);

 private:
  WorldData* world_;
};

/// Reads a primitive collider.
class ColliderView {
 public:
  ColliderView(const WorldData& world, ColliderId id) : read_(&world), id_(id) {}
  ColliderId id() const { return id_; }
  const std::string& name() const;  ///< valid until a collider is added or removed
  RigidPose pose() const;           ///< the current pose; its rotation is a unit quaternion

 private:
  const WorldData* read_;
  ColliderId id_;
};

/// Reads and controls a primitive collider, between steps.
class ColliderHandle : public ColliderView {
 public:
  ColliderHandle(WorldData& world, ColliderId id) : ColliderView(world, id), world_(&world) {}
  /// Moves the collider to a pose that it reaches at the end of the next step: position at constant velocity, rotation
  /// along the shorter arc. After that it stays, or follows its keyframes, if any. Throws an Error if the pose is not
  /// finite or its rotation is zero.
  void set_pose(const RigidPose& pose);
  /// Moves the collider at once, from its present pose, as ObjectHandle::teleport: what it touches gets no velocity.
  /// Throws an Error if it follows keyframes, or the motion is not finite.
  void teleport(const RigidPose& by);
  /// Gives its surface another velocity (Collider::surface_velocity) in the collider's frame [m/s], until the next call
  /// or restore(). Throws an Error if it is not finite or above 1e6 m/s.
  void set_surface_velocity(const Vec3f& velocity);

 private:
  WorldData* world_;
};

/// Reads a mesh collider.
class MeshColliderView {
 public:
  MeshColliderView(const WorldData& world, MeshColliderId id) : read_(&world), id_(id) {}
  MeshColliderId id() const { return id_; }
  const std::string& name() const;  ///< valid until something is added, removed or edited
  int vertex_count() const;
  /// The current positions of the vertices in the mesh's own order [m].
  std::vector<Vec3f> positions() const;
  /// Copies them into the caller's memory. Throws an Error if the size differs.
  void read_positions(std::span<Vec3f> into) const;

 private:
  const WorldData* read_;
  MeshColliderId id_;
};

/// Reads and controls a mesh collider, between steps.
class MeshColliderHandle : public MeshColliderView {
 public:
  MeshColliderHandle(WorldData& world, MeshColliderId id) : MeshColliderView(world, id), world_(&world) {}
  /// Moves it like a primitive collider. The pose applies to the mesh as deformed by its frames.
  void set_pose(const RigidPose& pose);
  /// Moves the vertices of a mesh that collides as triangles to positions that they reach at the end of the next step
  /// [m]. Throws an Error if it is a distance grid or a heightfield, or if size or values are wrong.
  void set_positions(std::span<const Vec3f> positions);
  /// Moves it at once like a primitive collider, deformed as it is.
  void teleport(const RigidPose& by);
  /// Gives its surface another velocity like that of a primitive collider.
  void set_surface_velocity(const Vec3f& velocity);

 private:
  WorldData* world_;
};

}  // namespace pliant
