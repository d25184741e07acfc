// The contents of a World. Its functions are in files by concern: objects.cpp (add, remove, edit), control.cpp,
// events.cpp, state.cpp, read.cpp, world.cpp (step).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/world.h"
#include "solver/kernels.h"
#include "solver/measure.h"
#include "solver/substep_group.h"
#include "solver/workspace.h"
#include "world/id_table.h"

namespace pliant {

/// The State of one object, in storage order.
struct ObjectState {
  Records positions, remainders, velocities, orientations, angular_velocities;
  std::vector<std::vector<float>> channels;
};

/// The groups to which a body belongs, and those that it meets.
struct Masks {
  std::uint32_t groups = 1, mask = ~0u;
};

/// Moves the particles of an object that follow keyframes to their positions at a time.
void move_to_present(const CompiledObject& object, double time, Record* positions);
/// The distance field of a mesh collider; null if it collides as triangles. Throws an Error if the mesh is unsuitable.
std::shared_ptr<const SolidField> field_of(const MeshCollider& collider);

// Over thirty members: each file named below holds one part's functions; all of them share the Model, State and Workspace.
struct World::Implementation {
  /// Objects of a scene that is given away are freed as soon as they are compiled; it is `scene` or null.
  Implementation(const Scene& scene, const Settings& with, Scene* given_away = nullptr);
  Implementation(const Scene& scene, const WorldLayout& layout);  ///< layout.cpp

  // ---- objects.cpp
  /// What the schedule of an object that is compiled now depends on besides the object.
  CompileOptions compile_options(Sweep sweep) const;
  /// The sweep for an object that is added now.
  Sweep sweep_of(const Object& object) const;
  /// Throws an Error if the World's acceleration does not support a sweep.
  void require_accelerable(Sweep sweep, const std::string& name) const;
  /// Adds a mesh collider to the model; returns its number.
  int add_to_model(const MeshCollider& collider, CompiledObject compiled);
  /// Adds the distance field of a mesh collider. Fields are ordered by the collider's number.
  void add_field(const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number);
  /// Allocates and fills the State and the workspace of an object just added to the model.
  void put(int number);
  /// Throws an Error if the origins of an edit's particles are invalid.
  void require_origins(int number, const Edit& edit) const;
  /// Replaces an object by another one; `from` as in Edit.
  void replace(int number, CompiledObject by, const std::vector<int>& from);
  /// Returns an object's part of the State, and replaces it by zeros.
  ObjectState take(int number);
  /// Gives particle i of an object the state of particle origins[i], or none for -1; both in storage order.
  void give_back(int number, const ObjectState& kept, const std::vector<int>& origins);
  /// Resizes the State to the model's particles and frames.
  void fit_state();
  void forget_pose(bool is_mesh, int slot);
  /// Removes an object from model, State and workspace.
  void remove(int number);
  /// Prepares the workspace for an object that was added, removed or recompiled.
  void prepare(int number);
  /// Notes an object that comes or goes if its surface could touch something.
  void note_surfaces(int number);
  void prepare_shape_contacts();
  /// Makes a group's contact among surfaces from all its objects.
  void make_pairs(SubstepGroup& group);
  /// Brings a group's contact up to date with changed objects: by number.
  void update_pairs(SubstepGroup& group, const std::vector<int>& changed);
  /// Gives a group the contact of the group of the same substeps before, up to date with what joined it or left.
  void take_over_pairs(SubstepGroup& group, SubstepGroup& before);
  /// The groups of objects that share their substeps, without contact among surfaces.
  std::vector<SubstepGroup> find_groups() const;
  /// Finds the groups and gives them their contact.
  void prepare_groups();
  /// Brings the contact of the one group of all objects up to date.
  void update_surfaces();
  /// Call before a step: does once what all additions and removals since the last step require.
  void bring_up_to_date();

  /// The number of an id in the model. Throws an Error if the id is stale.
  int number(ObjectId id) const { return object_ids.number(id); }
  const CompiledObject& object(ObjectId id) const { return model.objects[number(id)]; }
  const Collider& collider(ColliderId id) const { return model.colliders[collider_ids.number(id)]; }

  // ---- intersections.cpp
  /// Throws Error where the settings refuse initial intersections and what is about to be added has some.
  void refuse_intersections(const CompiledObject& added, const Masks& masks, bool is_grid) const;

  // ---- state.cpp
  /// Throws Error where a State's blocks are not those of this World.
  void require_blocks(const State& given) const;
  void require_held_poses(const State& given) const;

  // ---- control.cpp
  const HeldPose* held(bool is_mesh, int slot) const;
  Posed pose_now(ColliderId id) const;
  Posed pose_now(MeshColliderId id) const;
  /// Call before and after a step: sets the times of driven motions, and stores held poses.
  void begin_control(double dt);
  void stop_fixed();
  void end_control(bool stopped);
  /// Discards the control data of an object or collider that is removed.
  void forget_control(int number);

  // ---- events.cpp
  Thing thing_of(int body) const;
  void make_events();
  void forget_touching(const Thing& thing);

  // ---- read.cpp
  const Record* positions_of(ObjectId id) const { return state.positions.data() + model.first[number(id)]; }
  /// Converts records to the user's order, for an object or a mesh collider.
  std::vector<Vec3f> in_given_order(int number, const Records& records) const;
  void measure(Lengths& measured) const;
  /// Of the last step's substeps; any, where an object has made none and so has no multipliers [s].
  float h_of(int number) const {
    return number < static_cast<int>(last_h.size()) && last_h[number] > 0 ? last_h[number] : 1.f;
  }

  /// Substeps of a frame: those of an object as planned, and those into which a group divides the next frame.
  int substeps_of(int number) const;
  int substeps_for(const SubstepGroup& group, double dt, std::vector<std::string>& warnings) const;
  std::vector<GroupFrame> plan_frame(double dt, Report& report);

  Settings settings, suggested;  ///< the World's settings, and those that measured best on such scenes
  Executor executor;
  const Kernels& kernels;
  Model model;
  IdTable<Object> object_ids{"object"};                      ///< numbers in model.objects
  IdTable<Collider> collider_ids{"collider"};                ///< numbers in model.colliders
  IdTable<MeshCollider> mesh_collider_ids{"mesh collider"};  ///< numbers in model.objects
  std::unique_ptr<PairModel> pair_model;
  State state;
  Workspace workspace;
  std::vector<SubstepGroup> groups;
  Lengths lengths;
  std::vector<std::pair<Thing, Thing>> touching;  ///< pairs in contact in the last step, ascending
  std::vector<ContactEvent> events;
  std::vector<float> last_h;  ///< by object: of the substeps of the last step [s]
  bool stopped = false;
  const std::atomic<bool>* stop = nullptr;  ///< the flag of World::stop_when
  bool may_drift = false;             ///< fixed particles may have a velocity from a frame in which the user moved them
  std::vector<int> changed_surfaces;  ///< numbers of objects that came, went or were edited since the last step
  bool objects_changed = false;       ///< changes since the last step
};

}  // namespace pliant
