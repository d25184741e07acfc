// The data of a World. Its functions are divided over files: objects.cpp (add, remove, edit), control.cpp, events.cpp,
// state.cpp, read.cpp, world.cpp (step), intersections.cpp and layout.cpp.
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
#include "world/overstretch_record.h"

namespace pliant {

/// The part of the State that belongs to one object, in storage order.
struct ObjectState {
  Records positions, remainders, velocities, orientations, angular_velocities;
  std::vector<std::vector<float>> channels;
  float substeps = 0;  ///< State::substeps
};

/// Bit sets of collision groups: those that a body belongs to, and those that it meets.
struct Masks {
  std::uint32_t groups = 1, mask = ~0u;
};

/// Moves the particles of an object that have keyframes to their positions at `time` [s].
void move_to_present(const CompiledObject& object, double time, Record* positions);
/// The distance field of a mesh collider; null if it collides as triangles. Throws an Error if the mesh is unsuitable.
std::shared_ptr<const SolidField> field_of(const MeshCollider& collider);

// Over thirty members: each file named below has functions of one concern, and all work on the Model, State and Workspace.
struct World::Implementation {
  /// `with` are the settings chosen where those given are open. If `given_away` is not null, it is `scene`; its objects are
  /// freed as soon as they are compiled.
  Implementation(const Scene& scene, const Settings& given, const Settings& with, Scene* given_away = nullptr);
  Implementation(const Scene& scene, const WorldLayout& layout);  ///< defined in layout.cpp

  // ---- objects.cpp
  /// The substeps that the user named; 0: none, so that each set of objects has its own.
  int named_substeps() const { return substeps_are_open ? 0 : settings.substeps; }
  /// Data apart from the object on which the schedule of an object that is added now depends.
  CompileOptions compile_options(Sweep sweep) const;
  /// The sweep that an object gets if it is added now.
  Sweep sweep_of(const Object& object) const;
  /// Throws an Error if the acceleration in the settings does not support the sweep.
  void require_accelerable(Sweep sweep, const std::string& name) const;
  /// Adds a compiled mesh collider to the model. Returns its number.
  int add_to_model(const MeshCollider& collider, CompiledObject compiled);
  /// Adds the distance field of a mesh collider. Fields are ordered by the collider's number.
  void add_field(const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number);
  /// Allocates the State and the workspace of an object that was just added to the model, and fills them.
  void put(int number);
  /// Throws an Error if an edit names origins of particles that do not exist.
  void require_origins(int number, const Edit& edit) const;
  /// Replaces an object. `from` lists for each new particle the old one whose state it gets, as Edit::from.
  void replace(int number, CompiledObject by, const std::vector<int>& from);
  /// Returns the State of an object, and sets that part of the State to zero.
  ObjectState take(int number);
  /// Gives particle i of an object the kept state of particle origins[i], unless that is -1. All are in storage order.
  void give_back(int number, const ObjectState& kept, const std::vector<int>& origins);
  /// Resizes the State to the model's particles and frames.
  void fit_state();
  void forget_pose(bool is_mesh, int slot);
  /// Removes an object from model, State and workspace.
  void remove(int number);
  /// Prepares the workspace for an object that was added, removed or recompiled.
  void prepare(int number);
  /// Adds an object to changed_surfaces if its surface can touch something.
  void note_surfaces(int number);
  void prepare_shape_contacts();
  /// Makes the contact between surfaces for all objects of a group.
  void make_pairs(SubstepGroup& group);
  /// Updates the contact between surfaces of a group for the objects whose numbers are in `changed`.
  void update_pairs(SubstepGroup& group, const std::vector<int>& changed);
  /// Moves to a group the contact of the earlier group with equal substeps, and updates it for objects that changed group.
  void take_over_pairs(SubstepGroup& group, SubstepGroup& before);
  /// Finds the groups of objects with the same substeps. Their contact between surfaces is not made yet.
  std::vector<SubstepGroup> find_groups() const;
  /// Finds the groups, and makes their contact between surfaces or takes it over from the groups before.
  void prepare_groups();
  /// Updates the contact between surfaces, if all objects are in one group.
  void update_surfaces();
  /// Does what additions, removals and edits since the last step require; call it before a step.
  void bring_up_to_date();

  /// The number of an object in the model. Throws an Error if the id is stale.
  int number(ObjectId id) const { return object_ids.number(id); }
  const CompiledObject& object(ObjectId id) const { return model.objects[number(id)]; }
  const Collider& collider(ColliderId id) const { return model.colliders[collider_ids.number(id)]; }

  // ---- intersections.cpp
  /// Throws an Error if the settings refuse initial intersections and the object to be added has some.
  void refuse_intersections(const CompiledObject& added, const Masks& masks, bool is_grid) const;

  // ---- state.cpp
  /// Throws an Error if a State's blocks of particles differ from those of this World.
  void require_blocks(const State& given) const;
  void require_held_poses(const State& given) const;
  /// Sets multipliers to zero, so that the whole stretch counts; if `only_of_last`, those that are stored in the last
  /// substep of a frame only.
  void forget_multipliers(bool only_of_last);

  // ---- control.cpp
  const HeldPose* held(bool is_mesh, int slot) const;
  Posed pose_now(ColliderId id) const;
  Posed pose_now(MeshColliderId id) const;
  /// begin_control sets the times of user motions before a step; end_control stores poses that stay, after it.
  void begin_control(double dt);
  void stop_fixed();
  void end_control(bool stopped);
  /// Discards what the user set for an object or collider that is removed.
  void forget_control(int number);

  // ---- events.cpp
  Thing thing_of(int body) const;
  void make_events();
  void forget_touching(const Thing& thing);

  // ---- read.cpp
  const Record* positions_of(ObjectId id) const { return state.positions.data() + model.first[number(id)]; }
  /// Converts an array from storage order to the user's order, for an object or a mesh collider.
  std::vector<Vec3f> in_given_order(int number, const Records& records) const;
  Overstretch with_slot(Overstretch measured) const;
  /// Length of an object's substeps in the last step [s]; 1 if it took part in none, because then multipliers are zero.
  float h_of(int number) const { return workspace.last_h[number] > 0 ? workspace.last_h[number] : 1.f; }

  /// Substeps per frame: of an object as planned; and of a group in the next frame, which fast colliders can increase.
  int substeps_of(int number) const;
  GroupFrame plan(const SubstepGroup& group, double dt, std::vector<std::string>& warnings) const;
  std::vector<GroupFrame> plan_frame(double dt, Report& report);

  Settings settings;    ///< as World::settings() returns them
  std::string departs;  ///< departures() of the first objects: by which settings they depart from the default
  /// True if the user named none; `settings` then has what was chosen for the first objects.
  bool sweep_is_open = true, substeps_are_open = true;
  Executor executor;
  const Kernels& kernels;
  Model model;
  IdTable<Object> object_ids{"object"};                      ///< internal numbers: indices in model.objects
  IdTable<Collider> collider_ids{"collider"};                ///< internal numbers: indices in model.colliders
  IdTable<MeshCollider> mesh_collider_ids{"mesh collider"};  ///< internal numbers: indices in model.objects
  std::unique_ptr<PairModel> pair_model;
  State state;
  Workspace workspace;
  std::vector<SubstepGroup> groups;
  OverstretchRecord overstretch;
  std::vector<float> ratios;                      ///< scratch data of measure_stretch
  std::vector<std::pair<Thing, Thing>> touching;  ///< pairs of bodies that were in contact in the last step, ascending
  std::vector<ContactEvent> events;
  bool stopped = false;
  const std::atomic<bool>* stop = nullptr;  ///< flag given to World::stop_when
  bool may_drift = false;             ///< fixed particles may have a velocity from a frame in which the user moved them
  std::vector<int> changed_surfaces;  ///< numbers of objects added, removed or edited since the last step
  bool objects_changed = false;       ///< true if objects were added, removed or edited since the last step
};

}  // namespace pliant
