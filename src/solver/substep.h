// The current substep: the data on which every stage of solver/step.cpp works.
#pragma once

#include "core/at.h"
#include "solver/step.h"
#include "solver/systems/systems.h"
#include "solver/ways_out.h"

namespace pliant {

class BodySolver;

/// Views of the data of a step, and the numbers of one substep. Over fifteen members, because stages are free
/// functions, and each needs some of this data.
struct Substep {
  const StepContext& context;
  const Model& model;
  State& state;
  Workspace& work;
  const Kernels& kernels;
  SubstepScratch* own = nullptr;       ///< scratch data
  Report report{};                     ///< what this group adds to the frame's report
  const SubstepGroup* part = nullptr;  ///< objects that take part; null: all
  SurfaceContact* pairs = nullptr;     ///< contact of their surfaces; null if no two can touch
  const Systems* systems = nullptr;    ///< bodies, liquids, grains and gases; null: none
  BodySolver* bodies = nullptr;        ///< of these, contact of rigid bodies, which cloth and ropes need; or null
  double frame_start = 0, dt = 0;      ///< start and length of the frame [s]
  float h = 0;                         ///< length of a substep [s]
  int number = 0;                      ///< index of the substep in the frame, from 0
  int planned = 1;                     ///< substeps in the whole frame
  int substeps = 1;                    ///< substeps to make; fewer than planned if the frame is stopped
  double time_after = 0;               ///< time at the substep's end [s]
  bool sweeps_on_entry = false;      ///< true if predict runs the first sweep over tiles, each while it is in the cache
  bool update_is_due = false;        ///< true if update is deferred to the next predict (stages/advance.cpp)
  bool frames_are_finite = true;     ///< orientations after the last update, for objects that take part
  std::int64_t iterations_made = 0;  ///< iterations made in this frame
  /// The sweep group that is being iterated; null: loops over swept objects visit every object.
  const SweepGroup* group = nullptr;

  int least = 0, most = 0;         ///< bounds of substeps that follow the State; `most` is 0 if they are fixed
  int least_hanging = 0;           ///< replaces `least` in quarters in which the group hangs
  bool hangs = false;              ///< true if it does in this quarter: SubstepGroup::hangs, and its tethers hold
  int made = 0;                    ///< substeps made in this frame
  std::vector<WayOut> ways_out{};  ///< in this frame, of objects that started it inside of a collider
  int failed_in = -1;              ///< the substep of this frame in which a value was not finite; -1: none
  bool is_guarded = false;         ///< true in quarters with over 1.25 times the substeps of the last one
  double substeps_before = 0;      ///< per frame in the last quarter; 0: none
  float velocity_share = 1;        ///< share of the corrections that the update turns into velocity
  const std::vector<Task>* own_lengths = nullptr;  ///< SubstepGroup::lengths; null: none

  /// The distances that the limit and the law of substeps apply to.
  const std::vector<Task>& lengths() const {
    static const std::vector<Task> none;
    return own_lengths == nullptr ? none : *own_lengths;
  }
  bool follows_state() const { return most > 0; }
  bool is_last() const { return number + 1 == substeps; }
  bool has_pairs() const { return pairs != nullptr; }
  const std::vector<Phase>& phases() const { return part == nullptr ? model.phases : part->phases; }
};

/// The start time of substep number `substep` of the frame [s].
double time_of(const Substep& s, int substep);

/// What is left of the frame at the substep's start [s].
double time_left(const Substep& s);

/// The change of velocity by gravity over a time [m/s].
Vec3f gravity_for(const Substep& s, double seconds);

/// The position of a particle at the end of the substep as of now [m]; w is 0.
inline Record predicted_position(const Substep& s, std::int32_t particle) {
  const Record &x = s.state.positions[at(particle)], &d = s.work.displacements[at(particle)];
  return {x.x + d.x, x.y + d.y, x.z + d.z, 0};
}

/// True if forces change velocities before the prediction (stages/apply_forces.cpp).
bool changes_velocities(const Substep& s);

/// The arrays of an object's particles and multipliers, for projection.
SweepArguments arguments(const Substep& s, int object, bool first_pass);

/// The arrays of an object's frames, for projection.
FrameArguments frame_arguments(const Substep& s, int object);

/// The arrays of a tile's particles, for prediction and update.
AdvanceArguments particles(const Substep& s, int task);
/// All particles of an object, likewise.
AdvanceArguments object_particles(const Substep& s, int object);

/// The arrays of the particles of all objects, for contact between surfaces.
PairParticles all_particles(const Substep& s);

/// The object to which the tile of a task belongs; tile_of returns the tile.
inline const CompiledObject& object_of(const Substep& s, int task) {
  return s.model.objects[s.model.tiles()[task].object];
}
inline const Tile& tile_of(const Substep& s, int task) { return object_of(s, task).tiles[s.model.tiles()[task].item]; }

/// True if an object takes part in this substep.
inline bool takes_part(const Substep& s, int object) { return s.part == nullptr || s.part->has(object); }

/// True if the sweep group being iterated contains an object.
inline bool is_swept(const Substep& s, int object) {
  if (!takes_part(s, object)) return false;
  const CompiledObject& of = s.model.objects[object];
  return s.group == nullptr || (of.sweep == s.group->sweep && !of.is_collider);
}

/// Calls body(object) for every object that takes part in this substep.
template <class Body>
void for_objects(const Substep& s, const Body& body) {
  const auto count = s.part == nullptr ? s.model.objects.size() : s.part->objects.size();
  for (std::size_t i = 0; i < count; ++i) body(s.part == nullptr ? static_cast<int>(i) : s.part->objects[i]);
}

/// Calls body(task) for every tile of the objects that take part in this substep.
template <class Body>
void for_each_tile(const Substep& s, const Body& body) {
  const auto count = s.part == nullptr ? s.model.tiles().size() : s.part->tiles.size();
  for (std::size_t i = 0; i < count; ++i) body(s.part == nullptr ? static_cast<int>(i) : s.part->tiles[i]);
}

/// Calls body(system) for every system of the group, in their order.
template <class Body>
void for_systems(const Substep& s, const Body& body) {
  if (s.systems != nullptr)
    for (const auto& system : *s.systems) body(*system);
}

/// Parallel loops timed under `name`: over tiles of objects that take part, of swept objects, and over given tasks.
void for_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_swept_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_tasks(Substep& s, const char* name, int tasks, FunctionRef<void(int)> body);

}  // namespace pliant
