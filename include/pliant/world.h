// A World is a compiled Scene with the State that changes with time. Call step, then read.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/edit.h"
#include "pliant/handles.h"
#include "pliant/kept_schedule.h"
#include "pliant/measurements.h"
#include "pliant/report.h"
#include "pliant/scene.h"
#include "pliant/state.h"

namespace pliant {

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
  std::vector<KeptSchedule> schedules;                   ///< of each object; unused where its description decides
  /// True if the settings left them open: objects added later then get their own choice.
  bool sweep_is_open = false, substeps_are_open = false;
};

/// Asks a World to keep the descriptions of all that is in it (World::description).
struct KeepDescription {};

/// A simulation to step, change and read. Over thirty members, because what can be added, removed and found is
/// overloaded for objects, colliders and mesh colliders, and because it can be made in five ways.
class World {
 public:
  /// Compiles a scene. If it cannot be simulated, throws an Error that names object, element and remedy.
  explicit World(const Scene& scene);
  World(const Scene& scene, const Settings& settings);
  /// Does the same with less memory: frees each object's description when compiled. Keep a copy to save or edit
  /// objects.
  explicit World(Scene&& scene);
  World(Scene&& scene, const Settings& settings);
  /// Makes a World as it was after additions and removals. The scene describes its objects in the order of objects(),
  /// colliders() and mesh_colliders(), with its settings. Also throws an Error if scene and layout do not fit together.
  World(const Scene& scene, const WorldLayout& layout);
  /// Do the same, and keep the descriptions of all objects and colliders, so that description() returns them at any
  /// time. They take as much memory as the scene.
  World(const Scene& scene, KeepDescription keep);
  World(const Scene& scene, const WorldLayout& layout, KeepDescription keep);
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
  /// those keep theirs, even if the new one can touch them. If they name no substeps, sets of objects that can touch
  /// and are near are
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
  /// exactly; so do targets of attachments that go on: with the same particle and target, or else the same target. Pass
  /// a changed copy of the description with which it was added, or of description() if it tears. Returns for each old
  /// particle the first new index, or -1. If the old particles of an object of more than 2048 are the first of the new
  /// ones, as after tears and cuts, and most constraints have the particles that they had, only the others are
  /// scheduled again; otherwise the cost is that of compiling it. Throws an Error if the description cannot be
  /// simulated or `from` does not fit.
  std::vector<int> edit(ObjectId object, const Edit& edit);

  /// True if the id refers to an existing object or collider.
  bool has(ObjectId object) const;
  bool has(ColliderId collider) const;
  bool has(MeshColliderId collider) const;

  WorldLayout layout() const;

  /// True if the World was made with KeepDescription.
  bool keeps_description() const;
  /// A scene of the present contents: as given, added and edited, in the order of objects(), colliders() and
  /// mesh_colliders(), and objects that come apart as they are now. It has the settings of the scene that the World was
  /// made from, and the pairs, also those of what is removed, which a World of layout() keeps. Together with layout()
  /// and state() it makes the same World again. Throws an Error if the World was not made with KeepDescription.
  Scene description() const;

  /// The ids of the existing objects, ordered by slot. If none was removed, they are 0, 1, ...
  std::vector<ObjectId> objects() const;
  std::vector<ColliderId> colliders() const;
  std::vector<MeshColliderId> mesh_colliders() const;
  int object_count() const;

  /// Finds an object or collider by its name. Empty if none has it; the first by slot if several have it.
  std::optional<ObjectId> find(std::string_view object) const;
  std::optional<ColliderId> find_collider(std::string_view name) const;
  std::optional<MeshColliderId> find_mesh_collider(std::string_view name) const;

  // ---- Reading and control, between steps (handles.h, measurements.h).

  /// Handles. They throw an Error when they are used if the id is stale.
  ObjectView object(ObjectId id) const { return {*data_, id}; }
  ObjectHandle object(ObjectId id) { return {*data_, id}; }
  ColliderView collider(ColliderId id) const { return {*data_, id}; }
  ColliderHandle collider(ColliderId id) { return {*data_, id}; }
  MeshColliderView mesh_collider(MeshColliderId id) const { return {*data_, id}; }
  MeshColliderHandle mesh_collider(MeshColliderId id) { return {*data_, id}; }
  /// Energies, stretch and residuals of the present State, and advice.
  Measurements measure() const { return Measurements(*data_); }

  /// Starts or ends the recording of mean loads of joints (ObjectView::mean_joint_load; initially off). It costs what
  /// an evaluation of all joints does, in each substep.
  void record_joint_loads(bool on);

  // ---- Contact events.

  /// Starts or ends the recording of contact events (initially off). It costs one more pass over the contacts of a
  /// step.
  void record_contact_events(bool on);
  /// The contact events of the last step, ordered by participants: contacts that began, persisted or ended.
  const std::vector<ContactEvent>& contact_events() const;
  /// The same of the last step for each rigid body and what it touched, if contact events are recorded. Those of what
  /// is removed go with it.
  const std::vector<BodyTouch>& body_touches() const;

  /// The settings in use. A sweep or substeps that were left open are those chosen for the first objects; 0 substeps or
  /// the sweep `automatic` if these differ.
  const Settings& settings() const;
  std::string isa() const;  ///< the code path in use: "x86-64-v2", "-v3", "-v4" or "generic"
  int threads() const;

 private:
  std::unique_ptr<WorldData> data_;
};

}  // namespace pliant
