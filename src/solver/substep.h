// The current substep: the data on which every stage of solver/step.cpp works.
#pragma once

#include "solver/step.h"

namespace pliant {

/// Views of a step's data, and the numbers of one substep. Over fifteen members, because each stage needs some. Stages
/// are free functions.
struct Substep {
  const StepContext& context;
  const Model& model;
  State& state;
  Workspace& work;
  const Kernels& kernels;
  Report& report;
  const SubstepGroup* part = nullptr;  ///< the objects that make this substep; null: all
  SurfaceContact* pairs = nullptr;     ///< contact of their surfaces; null if none can touch another
  double frame_start = 0, dt = 0;      ///< start and length of the frame [s]
  float h = 0;                         ///< length of a substep [s]
  int number = 0;                      ///< index of the substep in the frame, from 0
  int planned = 1;                     ///< substeps of the whole frame
  int substeps = 1;                    ///< substeps made; fewer if the frame is stopped
  double time_after = 0;               ///< time at the substep's end [s]
  bool sweeps_on_entry = false;        ///< the first sweep over tiles is made by predict, mostly while each is in the cache
  bool update_is_due = false;          ///< true if update is deferred to the next predict (stages/advance.cpp)
  bool frames_are_finite = true;       ///< after the last update, of the objects that make this substep
  std::int64_t iterations_made = 0;    ///< iterations made in this frame
  const SweepGroup* group =
      nullptr;  ///< the group of objects being iterated; null: loops over swept objects visit every object

  bool is_last() const { return number + 1 == substeps; }
  bool has_pairs() const { return pairs != nullptr; }
  const std::vector<Phase>& phases() const { return part == nullptr ? model.phases : part->phases; }
};

/// The start time of substep number `substep` of the frame [s].
double time_of(const Substep& s, int substep);

/// The change of velocity by gravity over a time [m/s].
Vec3f gravity_for(const Substep& s, double seconds);

/// An object's particles and multipliers, as projections see them.
SweepArguments arguments(const Substep& s, int object, bool first_pass);

/// An object's frames, as projections see them.
FrameArguments frame_arguments(const Substep& s, int object);

/// A tile's particles, as prediction and update see them.
AdvanceArguments particles(const Substep& s, int task);

/// The particles of all objects, as contacts between surfaces see them.
PairParticles all_particles(const Substep& s);

/// The object of a task, and its tile.
inline const CompiledObject& object_of(const Substep& s, int task) { return s.model.objects[s.model.tiles()[task].object]; }
inline const Tile& tile_of(const Substep& s, int task) { return object_of(s, task).tiles[s.model.tiles()[task].item]; }

/// True if an object takes part in this substep.
inline bool takes_part(const Substep& s, int object) { return s.part == nullptr || s.part->has[object] != 0; }

/// True if an object belongs to the sweep group being iterated.
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

/// Calls body(task) for every tile of these objects.
template <class Body>
void for_each_tile(const Substep& s, const Body& body) {
  const auto count = s.part == nullptr ? s.model.tiles().size() : s.part->tiles.size();
  for (std::size_t i = 0; i < count; ++i) body(s.part == nullptr ? static_cast<int>(i) : s.part->tiles[i]);
}

/// Parallel loops, timed under `name`: over these tiles, over tiles of swept objects, and over tasks of the caller's own.
void for_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_swept_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_tasks(Substep& s, const char* name, int tasks, FunctionRef<void(int)> body);

}  // namespace pliant
