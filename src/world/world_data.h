// The data of a World. The functions that work on it are grouped by concern: object_store.h, groups.h, control.h,
// events.h and intersections.h.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/world.h"
#include "solver/bodies/contact_bodies.h"
#include "solver/kernels.h"
#include "solver/measure.h"
#include "solver/near_sets.h"
#include "solver/substep_group.h"
#include "solver/workspace.h"
#include "world/convergence_record.h"
#include "world/id_table.h"
#include "world/overstretch_record.h"

namespace pliant {

/// The ids of what is in a World, with internal numbers.
struct WorldIds {
  IdTable<Object> objects{"object"};                      ///< numbers: indices in Model::objects
  IdTable<Collider> colliders{"collider"};                ///< numbers: indices in Model::colliders
  IdTable<MeshCollider> mesh_colliders{"mesh collider"};  ///< numbers: indices in Model::objects
};

/// What the user left open in the settings; these then have what was chosen for the first objects.
struct OpenSettings {
  bool sweep = true, substeps = true;
  std::string departs;  ///< departures() of the first objects: by which settings they depart from the default
};

/// The substep groups of a World, and what changed since they were made.
struct WorldGroups {
  std::vector<SubstepGroup> all;
  NearSets near;                            ///< of the objects; made again with the groups
  std::vector<int> sets;                    ///< by number of an object, the first of its set in the last frame
  std::vector<SetSubsteps> plan;            ///< planned_substeps() of these sets, from which the groups were made
  std::shared_ptr<ContactTables> tables;    ///< shared by the contact of all groups; null if there is none
  std::unique_ptr<PairModel> pairs_of_all;  ///< contact between surfaces, if one group has all objects
  BodyMeshes body_meshes;                   ///< shared by all groups
  std::vector<int> changed_surfaces;        ///< the numbers of these objects whose surface can touch something
  std::vector<int> changed;                 ///< the numbers of all of these objects
  /// True if primitive colliders were added or removed, or joints broke, since the last step.
  bool bodies_meet_others = false;
  bool objects_changed = false;  ///< true if objects were added, removed or edited since the last step
};

/// The contact events of a World.
struct WorldEvents {
  std::vector<std::pair<Thing, Thing>> touching;  ///< pairs of bodies that were in contact in the last step, ascending
  std::vector<ContactEvent> of_last_step;
  std::vector<BodyTouch> touches;
};

/// What a World keeps, beside the descriptions of objects, if it was made with KeepDescription.
struct KeptScene {
  Scene rest;                                  ///< the scene without objects and colliders
  std::map<int, Collider> colliders;           ///< by slot of their id
  std::map<int, MeshCollider> mesh_colliders;  ///< by slot of their id
};

struct WorldData {
  /// `with` are the settings chosen where those given are open. If `given_away` is not null, it is `scene`; its objects
  /// are freed as soon as they are compiled.
  WorldData(const Scene& scene, const Settings& given, const Settings& with, Scene* given_away = nullptr);
  WorldData(const Scene& scene, const WorldLayout& layout);  ///< defined in layout.cpp

  /// The number of an object in the model. Throws an Error if the id is stale.
  int number(ObjectId id) const { return ids.objects.number(id); }
  const CompiledObject& object(ObjectId id) const { return model.objects[number(id)]; }
  const Collider& collider(ColliderId id) const { return model.colliders[ids.colliders.number(id)]; }

  Settings settings;            ///< as World::settings() returns them
  float frame_time = 1.f / 60;  ///< Scene::frame_time [s], by which inflated objects get their sweep and substeps
  OpenSettings open;
  Executor executor;
  const Kernels& kernels;
  Model model;
  WorldIds ids;
  State state;
  Workspace workspace;
  WorldGroups groups;
  OverstretchRecord overstretch;
  ConvergenceRecord convergence;
  WorldEvents events;
  /// By slot of their id: of objects that come apart, or of all if `kept_scene` is there.
  std::map<int, Object> descriptions;
  std::optional<KeptScene> kept_scene;
  std::vector<std::string> warnings;        ///< for the Report of the next step
  bool stopped = false;                     ///< true after a value that is not finite, until a State is restored
  const std::atomic<bool>* stop = nullptr;  ///< flag given to World::stop_when
  bool may_drift = false;  ///< fixed particles may have a velocity from a frame in which the user moved them
};

/// Copies a scene without its objects and colliders; defined in layout.cpp.
Scene without_things(const Scene& scene);

/// The substeps that the user named; 0: none, so that each set of objects has its own.
inline int named_substeps(const WorldData& world) { return world.open.substeps ? 0 : world.settings.substeps; }

/// Data apart from the object on which the schedule of an object that is added now depends.
CompileOptions compile_options(const WorldData& world, Sweep sweep);

/// The overstretch with the slot of its object instead of the number in the model.
Overstretch with_slot(const WorldData& world, Overstretch measured);

/// Sets multipliers to zero, so that the whole stretch counts; if `only_of_last`, those that are stored in the last
/// substep of a frame only.
void forget_multipliers(WorldData& world, bool only_of_last);

}  // namespace pliant
