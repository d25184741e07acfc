// A World is a Scene compiled, with the State that moves. Data runs one way: step, then read.
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

/// What was compiled for one object.
struct ObjectInfo {
  std::string name;
  int particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> constraints;  ///< by type, "volume" included
};

/// A solve is called good where no distance is longer than its force explains by more than this [-].
inline constexpr double tolerated_overstretch = 0.01;

/// A rigid transform: a point p of a collider's own frame is at rotation p + position.
struct RigidPose {
  Vec3f position{};  ///< [m]
  Quatf rotation{};  ///< of any length but zero
};

/// An object changed in place: what it is from now on, and where its particles come from. remove_triangles and cut make one;
/// masses, stiffness, pins and all else are changed in `object` itself.
struct Edit {
  Object object;
  /// Of each particle of `object`: the one before the edit whose position and velocity it takes, or -1 for a new one, which
  /// begins where `object` has it. Several may come from one.
  std::vector<int> from;
  // Frames keep their numbers: as far as there were as many, they keep orientation and angular velocity.
};

/// The object as it is, with no particle changed: an Edit to build on.
Edit unchanged(const Object& object);

/// Takes triangles out, with the constraints that only they held: those between two particles that no triangle joins any
/// more, and those among more whose triangles are not all there. Particles keep their numbers. Throws Error where a triangle
/// does not exist.
Edit remove_triangles(const Object& object, std::span<const int> triangles);

/// Cuts a surface along a path of particles, each joined to the next by an edge of a triangle. A particle is split where the cut
/// parts the triangles around it: those inside the path, and an end that lies on the border. Copies come after all other
/// particles and share their mass by the area of their triangles, so mass and momentum stay. Constraints between the two
/// sides go; an edge on the cut is held on either side by its share, by area, of its stiffness. Throws Error where two neighbours of the path share no
/// edge.
Edit cut(const Object& object, std::span<const int> path);

/// Where the things of a World stand: with a Scene that describes them, what makes the World anew with the same ids and the same
/// bits after things came and went. pliant::save writes it.
struct WorldLayout {
  struct Slot {
    int number = -1;     ///< of an object or mesh collider in `blocks`, of a collider among its like; -1: nothing is there
    int generation = 0;  ///< of what is there, or comes next
  };
  std::vector<Slot> objects, colliders, mesh_colliders;  ///< by slot
  std::vector<StateBlock> blocks;                        ///< by number
  std::vector<int> first_frames;                         ///< by number: of the object's frames in a State
  std::vector<Sweep> sweeps;                             ///< by number: the one that the object is solved by
};

/// More than thirty members: it is the one object that a user steps, changes and reads.
class World {
 public:
  /// Compiles a scene. Throws Error naming the object, the element and what to do where it can't be simulated.
  explicit World(const Scene& scene);
  World(const Scene& scene, const Settings& settings);
  /// Makes a World anew whose things came and went: the scene describes those that exist, in the order of objects(), colliders() and
  /// mesh_colliders(); its settings are those of that World. Throws Error too where the two do not fit.
  World(const Scene& scene, const WorldLayout& layout);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt seconds (finite, > 0, substeps of 1e-12 s or more; else nothing moves and the Report says so). After a
  /// non-finite value the World stops in the midst of the frame, its state made finite, and refuses to step (a Report whose
  /// `nonfinite` names no object) until it is restored; so it does where a force field throws. Keep dt even: constraints
  /// leave an error that belongs to their step, and a much shorter one after it turns what it mends into speed.
  Report step(float dt);

  /// From now on a step looks at the flag after each substep, and ends there where it is true, with Report::stopped: the State
  /// is that at the end of the substep, `time` with it, and the frame does not count. A flag that is true before a step lets
  /// nothing move. Another thread or a signal handler may set it. It must outlive the World or be taken back by nullptr.
  void stop_when(const std::atomic<bool>* flag);

  const State& state() const;
  /// Puts a state of this World back. Throws Error where it does not fit. Multipliers read as zero until the next step.
  void restore(const State& state);
  std::string state_hash() const { return hash(state()); }

  // ---- Objects come and go, between steps. A call that throws Error leaves the World as it was.

  /// Adds an object as it is now: the first frame of its keyframes is the one that follows. Costs what this object costs to
  /// compile; where it can touch other surfaces, contact is prepared anew before the next step. The World's sweep and
  /// substeps stay as chosen when it was made. Throws Error naming the element where it can't be simulated, or where the settings
  /// refuse initial intersections and it has some with what is there now; that check looks at all surfaces.
  ObjectId add(const Object& object);
  ColliderId add(const Collider& collider);
  MeshColliderId add(const MeshCollider& collider);

  /// Takes it out. Other ids stay as they are. Throws Error where there is no such thing any more.
  void remove(ObjectId object);
  void remove(ColliderId collider);
  void remove(MeshColliderId collider);

  /// Changes an object in place, as it moves: its id stays, and every particle with an origin keeps position and velocity
  /// exactly. Give the description that the object was added with, changed: the World keeps none. Returns the first new number
  /// of each old particle, or -1 where it is gone. Costs what the object costs to compile. Throws Error where the description can't
  /// be simulated or `from` does not fit.
  std::vector<int> edit(ObjectId object, const Edit& edit);

  /// Whether the id still names something.
  bool has(ObjectId object) const;
  bool has(ColliderId collider) const;
  bool has(MeshColliderId collider) const;

  WorldLayout layout() const;

  /// Those that exist, by slot.
  std::vector<ObjectId> objects() const;
  std::vector<ColliderId> colliders() const;
  std::vector<MeshColliderId> mesh_colliders() const;

  // ---- Control, between steps. Wrong sizes and values that are not finite throw Error naming object and element, and
  // nothing has changed then.

  /// Moves particles that no force moves (pins, infinite mass) to `positions` [m], where they are when the next step ends, at
  /// even speed. After it they stay, or follow their keyframes again where they have some.
  void set_targets(ObjectId object, std::span<const int> particles, std::span<const Vec3f> positions);
  /// The same for the targets of attachments, by their numbers in the Object.
  void set_attachment_targets(ObjectId object, std::span<const int> attachments, std::span<const Vec3f> positions);
  /// Moves colliders to where they are when the next step ends, translations at even speed, rotations along the shorter arc.
  /// After it they stay, or follow their keyframes again where they have some.
  void set_poses(std::span<const ColliderId> colliders, std::span<const RigidPose> poses);
  /// The same for mesh colliders: their mesh as given, deformed by its frames, in the pose.
  void set_poses(std::span<const MeshColliderId> colliders, std::span<const RigidPose> poses);
  /// Moves every vertex of a mesh collider as triangles to where it is when the next step ends [m].
  void set_positions(MeshColliderId collider, std::span<const Vec3f> positions);
  /// One velocity a particle [m/s]. Those of particles without free mass are passed over.
  void set_velocities(ObjectId object, std::span<const Vec3f> velocities);
  /// One impulse a particle [N s]: velocity += impulse / mass.
  void add_impulses(ObjectId object, std::span<const Vec3f> impulses);
  /// One force a particle [N], constant through the next step and gone after it. Replaces those of an earlier call.
  void set_forces(ObjectId object, std::span<const Vec3f> forces);

  // ---- Contact events.

  /// Whether steps find out which things touch. Off at first; where on, a step costs one more pass over contacts.
  void record_contact_events(bool on);
  /// Of the last step, ordered by things: what began to touch, still touches, and touches no longer.
  const std::vector<ContactEvent>& contact_events() const;

  /// How many objects there are. Unless one was removed, their indices from 0 on are their ids.
  int object_count() const;
  ObjectInfo info(ObjectId object) const;
  const Settings& settings() const;
  std::string isa() const;  ///< the code path in use: "x86-64-v2", "-v3", "-v4" or "generic"
  int threads() const;

  /// In the object's own numbering.
  std::vector<Vec3f> positions(ObjectId object) const;
  std::vector<Vec3f> velocities(ObjectId object) const;
  /// Of the object's frames, in the order of Object::frames.
  std::vector<Quatf> orientations(ObjectId object) const;
  std::vector<Vec3f> angular_velocities(ObjectId object) const;  ///< in world axes [rad/s]
  TriangleMesh mesh(ObjectId object) const;
  /// The same into the caller's memory, one a particle. Throws Error where the size is another.
  void read_positions(ObjectId object, std::span<Vec3f> into) const;
  void read_velocities(ObjectId object, std::span<Vec3f> into) const;
  void read_mesh_collider_positions(MeshColliderId collider, std::span<Vec3f> into) const;

  /// Without a copy, as stored: (x, y, z) and inverse mass, and velocities with w zero. Valid until the next step or change of the
  /// World. Record i is particle storage_order(object)[i]; numbers beyond the object's particles are targets of attachments.
  std::span<const Record> positions_in_storage_order(ObjectId object) const;
  std::span<const Record> velocities_in_storage_order(ObjectId object) const;
  std::span<const int> storage_order(ObjectId object) const;
  /// Where a collider is now.
  Vec3f collider_position(ColliderId collider) const;
  Quatf collider_rotation(ColliderId collider) const;
  /// Where the vertices of a mesh collider are now, in its own numbering [m]. Throws Error where there is no such collider.
  std::vector<Vec3f> mesh_collider_positions(MeshColliderId collider) const;

  /// Multipliers of the last substep in the order of the object's constraint groups of that type, row by row; empty where they were not
  /// kept. The force is lambda / h^2 along the gradient (XPBD, eq. 17).
  std::vector<float> multipliers(ObjectId object, const std::string& type) const;

  /// Kinetic and gravitational energy of all free particles [J]; heights from the origin.
  double kinetic_energy() const;
  double potential_energy() const;
  std::vector<Residual> residuals() const;
  Stretch stretch() const;
  /// Compliant constraints count in full where their multipliers are kept, as Settings::measure has it.
  Overstretch overstretch() const;
  /// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more"; empty without object.
  std::string describe(const Overstretch& found) const;
  /// Where the solve fell short in the step of a Report with Settings::measure, by how much, and what to do; empty where
  /// it did not, by no more than `tolerated_overstretch`. `advise` tries what helps.
  std::string advice(const Report& report) const;
  double enclosed_volume(ObjectId object) const;  ///< of its triangles [m^3]

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant
