// A World is a compiled Scene with the State that changes with time. Call step, then read.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/report.h"
#include "pliant/scene.h"
#include "pliant/state.h"

namespace pliant {

/// Facts about an object of a World.
struct ObjectInfo {
  std::string name;
  int particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> constraints;  ///< number of constraints of each type, "volume" included
  int substeps = 0;  ///< substeps per frame; 0: they follow the State. Fast colliders may increase them (Report::substeps)
};

/// A pose of a collider: a point p of its local frame is at rotation p + position.
struct RigidPose {
  Vec3f position{};  ///< position of the local frame's origin [m]
  Quatf rotation{};  ///< quaternion of any non-zero length
};

/// A change of an object: its new description, and where its particles come from. remove_triangles and cut make one. To
/// change masses, stiffness, pins and the like, change `object` yourself.
struct Edit {
  Object object;
  /// For each particle of `object`: the old particle whose position and velocity it takes, or -1 for a new one, which
  /// starts at its position in `object`. Several particles may have the same origin.
  std::vector<int> from;
  // Frames are matched by index: those that exist before and after keep orientation and angular velocity.
};

/// An Edit that changes nothing, as a start for changes of your own.
Edit unchanged(const Object& object);

/// Removes triangles, and the constraints that only they supported: pairs of particles that no triangle contains any
/// more, and larger stencils with a missing triangle. Particles keep their indices. Throws an Error if a triangle does
/// not exist.
Edit remove_triangles(const Object& object, std::span<const int> triangles);

/// Cuts a surface along a path of particles, each joined to the next by a triangle's edge. A particle is split where
/// the cut separates its triangles: inside the path, and at an end on the border. Copies follow all other particles;
/// masses are divided by triangle area, so mass and momentum are conserved. Constraints across the cut are removed. An
/// edge on the cut stays on both sides, its stiffness divided by area. Throws an Error if two neighbours of the path
/// share no edge.
Edit cut(const Object& object, std::span<const int> path);

/// The ids and the storage layout of a World. With a Scene that describes its objects, it gives a World with the same
/// ids and bits after additions and removals. pliant::save writes it.
struct WorldLayout {
  struct Slot {
    int number = -1;     ///< index of the object or mesh collider in `blocks`, or of the collider; -1: free slot
    int generation = 0;  ///< generation of the present id, or of the next one if the slot is free
  };
  std::vector<Slot> objects, colliders, mesh_colliders;  ///< ids: an entry for each slot
  std::vector<StateBlock> blocks;                        ///< block of each object or mesh collider
  std::vector<int> first_frames;                         ///< first frame of each object in a State
  std::vector<Sweep> sweeps;                             ///< sweep of each object
  /// True if the settings left them open: objects added later then get their own choice.
  bool sweep_is_open = false, substeps_are_open = false;
};

/// A simulation to step, change and read. Over thirty members, because it is the only object that a user needs for this.
class World {
 public:
  /// Compiles a scene. If it cannot be simulated, throws an Error that names object, element and remedy.
  explicit World(const Scene& scene);
  World(const Scene& scene, const Settings& settings);
  /// Does the same with less memory: frees each object's description when compiled. Keep a copy to save or edit objects.
  explicit World(Scene&& scene);
  World(Scene&& scene, const Settings& settings);
  /// Makes a World as it was after additions and removals. The scene describes its objects in the order of objects(),
  /// colliders() and mesh_colliders(), with its settings. Also throws an Error if scene and layout do not fit together.
  World(const Scene& scene, const WorldLayout& layout);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt seconds (finite, > 0, substeps of at least 1e-12 s; otherwise nothing moves, and the Report says
  /// so). After a value that is not finite, or an exception of a force field, the World stops within the frame with a
  /// finite State. It then rejects steps (the Report's `nonfinite` names no object) until a State is restored. Keep dt
  /// constant: a much shorter step turns the constraint error of a longer one into velocity.
  Report step(float dt);

  /// Reads the flag after each substep. If it is true, the step ends with Report::stopped: State and `time` are those
  /// at the end of the substep, and the frame does not count. If objects have different substeps, it ends at the next
  /// time at which substeps of all end, or, if all follow the State, at the next quarter of the frame. If it is true
  /// before a step, nothing moves. Other threads and signal handlers may set it. It must live as long as the World, or
  /// until it is replaced by nullptr.
  void stop_when(const std::atomic<bool>* flag);

  const State& state() const;
  /// Restores a State of this World. Throws an Error if it does not fit. Until the next step, all multipliers are zero.
  void restore(const State& state);
  std::string state_hash() const { return hash(state()); }

  // ---- Adding and removing, between steps. If a call throws an Error, the World is unchanged.

  /// Adds an object at the current time. Its keyframes act from the next frame on. The cost is that of compiling it. If
  /// the settings name no sweep, it gets the one that it would get in a scene of all present objects and colliders;
  /// those keep theirs, even if the new one can touch them. If they name no substeps, sets of objects that can touch are
  /// formed again. Throws an Error that names the element if the object cannot be simulated, or if the settings refuse
  /// its initial intersections with present objects; that check tests all surfaces.
  ObjectId add(const Object& object);
  ColliderId add(const Collider& collider);
  MeshColliderId add(const MeshCollider& collider);

  /// Removes an object. Other ids stay valid. Throws an Error if the id is stale.
  void remove(ObjectId object);
  void remove(ColliderId collider);
  void remove(MeshColliderId collider);

  /// Changes an object that moves: its id stays valid, and every particle with an origin keeps position and velocity
  /// exactly. Pass a changed copy of the description with which it was added, because the World keeps none. Returns for
  /// each old particle the first new index, or -1. The cost is that of compiling the object. Throws an Error if the
  /// description cannot be simulated or `from` does not fit.
  std::vector<int> edit(ObjectId object, const Edit& edit);

  /// True if the id refers to an existing object or collider.
  bool has(ObjectId object) const;
  bool has(ColliderId collider) const;
  bool has(MeshColliderId collider) const;

  WorldLayout layout() const;

  /// The ids of the existing objects, ordered by slot.
  std::vector<ObjectId> objects() const;
  std::vector<ColliderId> colliders() const;
  std::vector<MeshColliderId> mesh_colliders() const;

  // ---- Control, between steps. Calls with wrong sizes or values that are not finite throw an Error that names object
  // and element, and change nothing.

  /// Moves kinematic particles (pins, infinite mass) at constant velocity to `positions` [m], which they reach at the
  /// end of the next step. After that they stay, or follow their keyframes, if any.
  void set_targets(ObjectId object, std::span<const int> particles, std::span<const Vec3f> positions);
  /// Moves the targets of attachments in the same way. `attachments` are indices in the Object.
  void set_attachment_targets(ObjectId object, std::span<const int> attachments, std::span<const Vec3f> positions);
  /// Moves colliders to poses that they reach at the end of the next step: position at constant velocity, rotation
  /// along the shorter arc. After that they stay, or follow their keyframes, if any.
  void set_poses(std::span<const ColliderId> colliders, std::span<const RigidPose> poses);
  /// Moves mesh colliders in the same way. The pose applies to the mesh as deformed by its frames.
  void set_poses(std::span<const MeshColliderId> colliders, std::span<const RigidPose> poses);
  /// Moves the vertices of a mesh collider (as triangles) to positions that they reach at the end of the next step [m].
  void set_positions(MeshColliderId collider, std::span<const Vec3f> positions);
  /// Sets the velocity of each particle [m/s]; those of infinite mass are skipped.
  void set_velocities(ObjectId object, std::span<const Vec3f> velocities);
  /// Adds an impulse to each particle [N s]: velocity += impulse / mass.
  void add_impulses(ObjectId object, std::span<const Vec3f> impulses);
  /// Applies a constant force to each particle during the next step [N]. Replaces the forces of an earlier call.
  void set_forces(ObjectId object, std::span<const Vec3f> forces);

  // ---- Contact events.

  /// Starts or ends the recording of contact events (initially off). It costs one more pass over the contacts of a step.
  void record_contact_events(bool on);
  /// The contact events of the last step, ordered by participants: contacts that began, persisted or ended.
  const std::vector<ContactEvent>& contact_events() const;

  /// The number of objects. If none was removed, their ids are 0, 1, ...
  int object_count() const;
  ObjectInfo info(ObjectId object) const;
  /// The settings in use. A sweep or substeps that were left open are those chosen for the first objects; 0 substeps or
  /// the sweep `automatic` if these differ.
  const Settings& settings() const;
  std::string isa() const;  ///< the code path in use: "x86-64-v2", "-v3", "-v4" or "generic"
  int threads() const;

  /// The positions of an object's particles in the user's order [m].
  std::vector<Vec3f> positions(ObjectId object) const;
  std::vector<Vec3f> velocities(ObjectId object) const;
  /// The orientations of an object's frames, in the order of Object::frames.
  std::vector<Quatf> orientations(ObjectId object) const;
  std::vector<Vec3f> angular_velocities(ObjectId object) const;  ///< in world axes, in the order of Object::frames [rad/s]
  TriangleMesh mesh(ObjectId object) const;
  /// Copies positions into the caller's memory, one for each particle. Throws an Error if the size differs.
  void read_positions(ObjectId object, std::span<Vec3f> into) const;
  void read_velocities(ObjectId object, std::span<Vec3f> into) const;
  void read_mesh_collider_positions(MeshColliderId collider, std::span<Vec3f> into) const;

  /// Views of an object's particles in storage order: positions with the inverse mass as w, and velocities with w zero.
  /// They are valid until the next step or change. Record i is particle storage_order(object)[i]; indices beyond the
  /// object's own particles are targets of attachments.
  std::span<const Record> positions_in_storage_order(ObjectId object) const;
  std::span<const Record> velocities_in_storage_order(ObjectId object) const;
  std::span<const int> storage_order(ObjectId object) const;
  /// The current pose of a collider: position, and rotation below.
  Vec3f collider_position(ColliderId collider) const;
  Quatf collider_rotation(ColliderId collider) const;
  /// The present vertex positions of a mesh collider in its own order [m]. Throws an Error if the collider does not exist.
  std::vector<Vec3f> mesh_collider_positions(MeshColliderId collider) const;

  /// The multipliers of the last substep in the order of the object's constraint groups of that type, row by row; empty
  /// if they were not stored: those of compliant distances always are, others if Settings::record_multipliers is set. The
  /// force is lambda / h^2 along the gradient (XPBD, eq. 17).
  std::vector<float> multipliers(ObjectId object, const std::string& type) const;

  /// Kinetic and gravitational energy of all dynamic particles [J]. Heights are relative to the origin.
  double kinetic_energy() const;
  double potential_energy() const;
  std::vector<Residual> residuals() const;
  Stretch stretch() const;
  /// The overstretch of the present State. Before the first step, after World::restore and after a frame that was not
  /// completed, the forces in compliant constraints are unknown, so their whole stretch counts.
  Overstretch overstretch() const;
  /// Describes it: "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more". Of an
  /// object that was removed, or edited so that it lacks these particles, only the figures.
  std::string describe(const Overstretch& found) const;
  /// Says where the solve fell short, by how much, and what to do; empty if is_tolerable(found). `found` is that of a
  /// frame of this World, or the worst of all. pliant::advise tries remedies.
  std::string advice(const Overstretch& found) const;
  /// The same for the frame of a Report; empty if that was not completed.
  std::string advice(const Report& report) const;
  double enclosed_volume(ObjectId object) const;  ///< volume enclosed by the object's triangles [m^3]

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant
