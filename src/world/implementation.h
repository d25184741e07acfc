// What a World holds. Its parts are in files by concern: objects.cpp (add, remove, edit), control.cpp, events.cpp, state.cpp,
// read.cpp, world.cpp (step).
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

/// What moves of one object, in storage order.
struct ObjectState {
  Records positions, remainders, velocities, orientations, angular_velocities;
  std::vector<std::vector<float>> channels;
};

/// Groups that a body is in and those that it meets.
struct Masks {
  std::uint32_t groups = 1, mask = ~0u;
};

/// Moves what follows keyframes to where they have it at a time.
void move_to_present(const CompiledObject& object, double time, Record* positions);
/// What particles meet of a mesh collider; null where that is its triangles. Throws Error where the mesh does not suit.
std::shared_ptr<const SolidField> field_of(const MeshCollider& collider);

// Over thirty members: each file named below holds one part's functions; all of them share the Model, State and Workspace.
struct World::Implementation {
  /// Objects of a scene that is given away are freed as soon as they are compiled; it is `scene` or null.
  Implementation(const Scene& scene, const Settings& with, Scene* given_away = nullptr);
  Implementation(const Scene& scene, const WorldLayout& layout);  ///< layout.cpp

  // ---- objects.cpp
  /// What the schedule of an object that is compiled now depends on besides the object.
  CompileOptions compile_options(Sweep sweep) const;
  /// The sweep of an object that is added now.
  Sweep sweep_of(const Object& object) const;
  /// Throws Error where the World's acceleration does not suit a sweep.
  void require_accelerable(Sweep sweep, const std::string& name) const;
  /// Adds a mesh collider to the model; its number there.
  int add_to_model(const MeshCollider& collider, CompiledObject compiled);
  /// What particles meet of a mesh collider that is no triangles. Fields stand in the order of their numbers.
  void add_field(const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number);
  /// Gives an object of the model, just added, a place in the State and in the workspace.
  void put(int number);
  /// Throws Error where the origins of an edit's particles do not fit.
  void require_origins(int number, const Edit& edit) const;
  /// Puts another in its place; `from` as in Edit.
  void replace(int number, CompiledObject by, const std::vector<int>& from);
  /// Takes what moves of an object out of the State, where zeros stay.
  ObjectState take(int number);
  /// Gives particle i of an object what particle origins[i] had, -1 for none; both in storage order.
  void give_back(int number, const ObjectState& kept, const std::vector<int>& origins);
  /// Makes the columns of the State as long as the model has particles and frames.
  void fit_state();
  void forget_pose(bool is_mesh, int slot);
  /// Takes it out of model, State and workspace.
  void remove(int number);
  /// Makes room in the workspace for an object that was added, removed or recompiled.
  void prepare(int number);
  /// Notes an object that comes or goes if its surface could touch something.
  void note_surfaces(int number);
  void prepare_shape_contacts();
  /// Makes contact among surfaces from all objects.
  void prepare_pairs();
  /// Brings what was noted into it.
  void update_pairs();
  /// Which objects share their substeps. Where not all do, contact among surfaces is made from all objects.
  void prepare_groups();
  /// Before a step: what only needs to be done once for all that came and went since the last.
  void bring_up_to_date();

  /// Numbers in the model. Throw Error where the id names nothing.
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
  /// Before and after a step: times of what is driven, and poses that are held.
  void begin_control(double dt);
  void stop_fixed();
  void end_control(bool stopped);
  /// What was given for an object or collider that goes.
  void forget_control(int number);

  // ---- events.cpp
  Thing thing_of(int body) const;
  void make_events();
  void forget_touching(const Thing& thing);

  // ---- read.cpp
  const Record* positions_of(ObjectId id) const { return state.positions.data() + model.first[number(id)]; }
  /// In the numbering of the user, of an object or a mesh collider.
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

  Settings settings, suggested;  ///< as they are, and as measured best on scenes of this kind
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
  std::vector<std::pair<Thing, Thing>> touching;  ///< in the last step, ascending
  std::vector<ContactEvent> events;
  std::vector<float> last_h;  ///< by object: of the substeps of the last step [s]
  bool stopped = false;
  const std::atomic<bool>* stop = nullptr;  ///< of stop_when
  bool may_drift = false;             ///< fixed particles may have a velocity from a frame in which the user moved them
  std::vector<int> changed_surfaces;  ///< numbers of objects that came, went or were edited since the last step
  bool objects_changed = false;       ///< since the last step
};

}  // namespace pliant
