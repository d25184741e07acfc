// A World is a compiled Scene with the State that changes over time. Call step, then read.
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

/// Information on a compiled object.
struct ObjectInfo {
  std::string name;
  int particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> constraints;  ///< number of constraints by type, including "volume"
  int substeps = 0;  ///< per frame; a frame with a fast collider may have more (Report::substeps)
};

/// The solve counts as good if no distance is longer by more than this share than its force explains [-].
inline constexpr double tolerated_overstretch = 0.01;

/// A rigid transform: a point p of a collider's local frame is at rotation p + position.
struct RigidPose {
  Vec3f position{};  ///< [m]
  Quatf rotation{};  ///< any non-zero length
};

/// An object edited in place: its new description, and the origin of its particles. remove_triangles and cut make one. To
/// edit masses, stiffness, pins and all else, change `object` itself.
struct Edit {
  Object object;
  /// For each particle of `object`: the old particle whose position and velocity it takes, or -1 for a new one, which
  /// starts at its position in `object`. Several may have one origin.
  std::vector<int> from;
  // Frames keep their indices: the first ones that exist before and after keep orientation and angular velocity.
};

/// The unchanged object, as the starting point of an Edit.
Edit unchanged(const Object& object);

/// Removes triangles and the constraints that only they supported: pairs that
/// no triangle joins any more, and larger stencils with a missing triangle.
/// Particles keep their indices. Throws an Error if a triangle does not exist.
Edit remove_triangles(const Object& object, std::span<const int> triangles);

/// Cuts a surface along a path of particles joined by triangle edges. A particle is split where
/// the cut separates the triangles around it: inside the path, and at an end on the border. Copies
/// follow all other particles and share the mass by triangle area, so mass and momentum are
/// conserved. Constraints across the cut are removed; an edge on the cut stays on both sides with
/// its stiffness shared by area. Throws an Error if two neighbours of the path share no edge.
Edit cut(const Object& object, std::span<const int> path);

/// The ids and storage layout of a World. With a Scene that describes its objects, it recreates the World with the same ids
/// and bits after additions and removals. pliant::save writes it.
struct WorldLayout {
  struct Slot {
    int number = -1;     ///< of an object or mesh collider in `blocks`, or of a primitive collider; -1: the slot is free
    int generation = 0;  ///< generation of the current occupant, or of the next
  };
  std::vector<Slot> objects, colliders, mesh_colliders;  ///< by slot
  std::vector<StateBlock> blocks;                        ///< by index
  std::vector<int> first_frames;                         ///< by index: first frame of the object in a State
  std::vector<Sweep> sweeps;                             ///< by index: the sweep of the object
};

/// It has more than thirty members, because it is the one object that a user steps, changes and reads.
class World {
 public:
  /// Compiles a scene. Throws an Error that names object, element and remedy if it cannot be simulated.
  explicit World(const Scene& scene);
  World(const Scene& scene, const Settings& settings);
  /// The same in less memory: each object's description is freed once compiled. Keep a copy to save the World or edit objects.
  explicit World(Scene&& scene);
  World(Scene&& scene, const Settings& settings);
  /// Recreates a World after additions and removals. The scene describes the existing objects in the order of objects(),
  /// colliders() and mesh_colliders(), with that World's settings. Throws an Error also if the two are inconsistent.
  World(const Scene& scene, const WorldLayout& layout);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt seconds (finite, > 0, substeps of at least 1e-12 s; otherwise nothing moves and the Report says so).
  /// After a non-finite value, or an exception of a force field, the World stops within the frame with a finite State. It
  /// then rejects steps (a Report whose `nonfinite` names no object) until it is restored. Keep dt constant: a much shorter
  /// step turns the constraint error of a longer one into velocity.
  Report step(float dt);

  /// Polls the flag after each substep and ends the step if it is true, with Report::stopped: State and `time` are those at
  /// the end of the substep, and the frame does not count. Where objects have different substeps, it ends at the next time
  /// that is the end of a substep of all. If it is true before a step, nothing moves. Other threads and
  /// signal handlers may set it. It must outlive the World or be reset by nullptr.
  void stop_when(const std::atomic<bool>* flag);

  const State& state() const;
  /// Restores a State of this World. Throws an Error if it does not fit. Multipliers read as zero until the next step.
  void restore(const State& state);
  std::string state_hash() const { return hash(state()); }

  // ---- Adding and removing, between steps. A call that throws an Error leaves the World unchanged.

  /// Adds an object at the current time: its keyframes act from the next frame on. The cost is that of compiling it. A sweep
  /// and substeps that the World chose for all its first objects stay (see settings()), even if contact now calls for others:
  /// name both in Settings if more will come. Throws an Error that names the element if it cannot be simulated, or if the
  /// settings reject its initial intersections with present objects; that check tests all surfaces.
  ObjectId add(const Object& object);
  ColliderId add(const Collider& collider);
  MeshColliderId add(const MeshCollider& collider);

  /// Removes an object. Other ids stay valid. Throws an Error if the id is stale.
  void remove(ObjectId object);
  void remove(ColliderId collider);
  void remove(MeshColliderId collider);

  /// Edits a moving object in place: its id stays valid, and every particle with an origin keeps position and velocity
  /// exactly. Pass the changed description with which the object was added, because the World keeps none. Returns the first
  /// new index of each old particle, or -1. The cost is that of compiling the object. Throws an Error if the description
  /// cannot be simulated or `from` does not fit.
  std::vector<int> edit(ObjectId object, const Edit& edit);

  /// True if the id is valid.
  bool has(ObjectId object) const;
  bool has(ColliderId collider) const;
  bool has(MeshColliderId collider) const;

  WorldLayout layout() const;

  /// The ids of the existing objects, by slot.
  std::vector<ObjectId> objects() const;
  std::vector<ColliderId> colliders() const;
  std::vector<MeshColliderId> mesh_colliders() const;

  // ---- Control, between steps. Wrong sizes and non-finite values
  // throw an Error that names object and element, and change nothing.

  /// Moves kinematic particles (pins, infinite mass) at constant velocity to `positions` [m], which they reach at the end
  /// of the next step. Then they stay, or follow their keyframes again, if any.
  void set_targets(ObjectId object, std::span<const int> particles, std::span<const Vec3f> positions);
  /// The same for the targets of attachments, by their indices in the Object.
  void set_attachment_targets(ObjectId object, std::span<const int> attachments, std::span<const Vec3f> positions);
  /// Moves colliders to poses that they reach at the end of the next step: translation at constant velocity, rotation along
  /// the shorter arc. Then they stay, or follow their keyframes again, if any.
  void set_poses(std::span<const ColliderId> colliders, std::span<const RigidPose> poses);
  /// The same for mesh colliders: the given mesh, deformed by its frames, in the pose.
  void set_poses(std::span<const MeshColliderId> colliders, std::span<const RigidPose> poses);
  /// Moves each vertex of a mesh collider (as triangles) to the position that it reaches at the end of the next step [m].
  void set_positions(MeshColliderId collider, std::span<const Vec3f> positions);
  /// One velocity per particle [m/s]. Particles of infinite mass are skipped.
  void set_velocities(ObjectId object, std::span<const Vec3f> velocities);
  /// One impulse per particle [N s]: velocity += impulse / mass.
  void add_impulses(ObjectId object, std::span<const Vec3f> impulses);
  /// One force per particle [N], constant during the next step only. Replaces those of an earlier call.
  void set_forces(ObjectId object, std::span<const Vec3f> forces);

  // ---- Contact events.

  /// Turns the recording of contact events on or off (initially off). It costs one more pass over the contacts of a step.
  void record_contact_events(bool on);
  /// Events of the last step, ordered by participants: contacts that began, persist or ended.
  const std::vector<ContactEvent>& contact_events() const;

  /// The number of objects. Unless one was removed, the ids are 0, 1, ...
  int object_count() const;
  ObjectInfo info(ObjectId object) const;
  const Settings& settings() const;
  std::string isa() const;  ///< the code path in use: "x86-64-v2", "-v3", "-v4" or "generic"
  int threads() const;

  /// The positions in the user's particle order [m].
  std::vector<Vec3f> positions(ObjectId object) const;
  std::vector<Vec3f> velocities(ObjectId object) const;
  /// The orientations of the object's frames, in the order of Object::frames.
  std::vector<Quatf> orientations(ObjectId object) const;
  std::vector<Vec3f> angular_velocities(ObjectId object) const;  ///< in world axes [rad/s]
  TriangleMesh mesh(ObjectId object) const;
  /// Copies positions into the caller's memory, one entry per particle. Throws an Error if the size differs.
  void read_positions(ObjectId object, std::span<Vec3f> into) const;
  void read_velocities(ObjectId object, std::span<Vec3f> into) const;
  void read_mesh_collider_positions(MeshColliderId collider, std::span<Vec3f> into) const;

  /// Views in storage order: (x, y, z) with inverse mass, and velocities with w zero. Valid until the next step or
  /// change. Record i is particle storage_order(object)[i]; indices beyond the object's particles are attachment
  /// targets.
  std::span<const Record> positions_in_storage_order(ObjectId object) const;
  std::span<const Record> velocities_in_storage_order(ObjectId object) const;
  std::span<const int> storage_order(ObjectId object) const;
  /// The current pose of a collider.
  Vec3f collider_position(ColliderId collider) const;
  Quatf collider_rotation(ColliderId collider) const;
  /// The current vertex positions of a mesh collider, in its own order [m]. Throws an Error if it does not exist.
  std::vector<Vec3f> mesh_collider_positions(MeshColliderId collider) const;

  /// The multipliers of the last substep in the order of the object's constraint groups of that type, row by row; empty if
  /// they were not stored. The force is lambda / h^2 along the gradient (XPBD, eq. 17).
  std::vector<float> multipliers(ObjectId object, const std::string& type) const;

  /// Kinetic and gravitational energy of all dynamic particles [J]; heights relative to the origin.
  double kinetic_energy() const;
  double potential_energy() const;
  std::vector<Residual> residuals() const;
  Stretch stretch() const;
  /// The current overstretch. Compliant constraints count in full if multipliers are stored
  /// (Settings::measure).
  Overstretch overstretch() const;
  /// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more"; empty without object.
  std::string describe(const Overstretch& found) const;
  /// How the solve fell short in the step of a Report with Settings::measure, by how much, and what to do; empty if
  /// overstretch is within `tolerated_overstretch`. `advise` tries remedies.
  std::string advice(const Report& report) const;
  double enclosed_volume(ObjectId object) const;  ///< of its triangles [m^3]

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant
