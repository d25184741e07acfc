// The substep under way: what every stage of solver/step.cpp works on.
#pragma once

#include "solver/step.h"

namespace pliant {

/// Views of what a step works with and the numbers of one substep: over fifteen, since each stage needs some. Stages are free
/// functions.
struct Substep {
  const StepContext& context;
  const Model& model;
  State& state;
  Workspace& work;
  const Kernels& kernels;
  Report& report;
  const SubstepGroup* part = nullptr;  ///< the objects that make this substep; null: all
  SurfaceContact* pairs = nullptr;     ///< theirs; null if no surface can touch another
  double frame_start = 0, dt = 0;      ///< of the frame [s]
  float h = 0;                         ///< of a substep [s]
  int number = 0;                      ///< of the substep within the frame, from 0
  int planned = 1;                     ///< substeps of the whole frame
  int substeps = 1;                    ///< of the frame, fewer where it is stopped
  double time_after = 0;               ///< at the substep's end [s]
  bool sweeps_on_entry = false;  ///< predict makes the first sweep over a tile's constraints while the tile is in the cache
  bool update_is_due = false;    ///< update has left its work to the next predict (stages/advance.cpp)
  std::int64_t iterations_made = 0;  ///< in this frame
  const SweepGroup* group =
      nullptr;  ///< whose iteration is under way; null: every object takes part in loops over the swept

  bool is_last() const { return number + 1 == substeps; }
  bool has_pairs() const { return pairs != nullptr; }
  const std::vector<Phase>& phases() const { return part == nullptr ? model.phases : part->phases; }
};

/// When substep number `substep` of the frame begins [s].
double time_of(const Substep& s, int substep);

/// Gravity over a time [m/s].
Vec3f gravity_for(const Substep& s, double seconds);

/// An object's particles and multipliers, as projections see them.
SweepArguments arguments(const Substep& s, int object, bool first_pass);

/// An object's frames, as projections see them.
FrameArguments frame_arguments(const Substep& s, int object);

/// A tile's particles, as prediction and update see them.
AdvanceArguments particles(const Substep& s, int task);

/// Those of all objects, as contacts among surfaces see them.
PairParticles all_particles(const Substep& s);

/// The tile of a task, and the object that it is of.
inline const CompiledObject& object_of(const Substep& s, int task) { return s.model.objects[s.model.tiles()[task].object]; }
inline const Tile& tile_of(const Substep& s, int task) { return object_of(s, task).tiles[s.model.tiles()[task].item]; }

/// Whether an object makes this substep.
inline bool takes_part(const Substep& s, int object) { return s.part == nullptr || s.part->has[object] != 0; }

/// Whether an object is of the group whose iteration is under way.
inline bool is_swept(const Substep& s, int object) {
  if (!takes_part(s, object)) return false;
  const CompiledObject& of = s.model.objects[object];
  return s.group == nullptr || (of.sweep == s.group->sweep && !of.is_collider);
}

/// Calls body(object) for every object that makes this substep.
template <class Body>
void for_objects(const Substep& s, const Body& body) {
  const auto count = s.part == nullptr ? s.model.objects.size() : s.part->objects.size();
  for (std::size_t i = 0; i < count; ++i) body(s.part == nullptr ? static_cast<int>(i) : s.part->objects[i]);
}

/// Calls body(task) for every tile of theirs.
template <class Body>
void for_each_tile(const Substep& s, const Body& body) {
  const auto count = s.part == nullptr ? s.model.tiles().size() : s.part->tiles.size();
  for (std::size_t i = 0; i < count; ++i) body(s.part == nullptr ? static_cast<int>(i) : s.part->tiles[i]);
}

/// Parallel loops, timed under `name`: over these tiles, over those of objects that are swept, and over tasks of the caller's own.
void for_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_swept_tiles(Substep& s, const char* name, FunctionRef<void(int)> body);
void for_tasks(Substep& s, const char* name, int tasks, FunctionRef<void(int)> body);

}  // namespace pliant
