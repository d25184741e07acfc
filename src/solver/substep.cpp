#include "solver/substep.h"

#include "solver/forces.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

double time_of(const Substep& s, int substep) { return s.frame_start + s.dt * substep / s.planned; }

Vec3f gravity_for(const Substep& s, double seconds) { return s.model.gravity * static_cast<float>(seconds); }

namespace {

/// Half by theory; the rest, of second order, is fitted to bars with the default substeps (docs/internals/solids.md).
/// It fits woven sheets as well (docs/internals/woven.md).
constexpr float lead_of_one_pass = 0.62f;

/// True if each constraint is projected once in a substep, in Gauss-Seidel's way.
bool solves_in_one_pass(const Substep& s, int object) {
  const SweepMethod& method = sweep_method(s.model.objects[object].sweep);
  return method.begins_on_entry && method.passes == 1 && s.context.iterations == 1 && s.context.options.relaxation == 1;
}

}  // namespace

bool changes_velocities(const Substep& s) {
  if (has_forces(s.model, s.work.control)) return true;
  bool any = false;
  for_systems(s, [&](const System& system) { any = any || system.changes_velocities(); });
  return any;
}

SweepArguments arguments(const Substep& s, int object, bool first_pass) {
  const int first = s.model.first[object];
  SweepArguments a;
  a.positions = s.state.positions.data() + first;
  a.displacements = s.work.displacements.data() + first;
  a.remainders = s.state.remainders.data() + first;
  a.velocities = (changes_velocities(s) ? s.work.velocities_before : s.state.velocities).data() + first;
  a.gravity = gravity_for(s, s.work.gravity[object].settled);
  a.keeps_energy = s.context.keeps_energy;
  const bool is_stored =
      !s.work.multiplier_pointers[object].empty() && (s.is_last() || s.work.stores_in_last[object] == 0);
  const auto& pointers = s.is_last() ? s.work.multiplier_pointers : s.work.pointers_before_last;
  a.multipliers = is_stored ? pointers[object].data() : nullptr;
  const auto& skipped = s.work.joints[object].skipped;
  a.skipped = skipped.empty() ? nullptr : skipped.data();
  a.h = s.h;
  a.inverse_h = 1 / s.h;
  a.inverse_h2 = (1 / s.h) * (1 / s.h);
  a.first_pass = first_pass;
  a.lead = solves_in_one_pass(s, object) ? lead_of_one_pass : 0;
  a.relaxation = s.context.options.relaxation;
  return a;
}

double time_left(const Substep& s) { return s.number == 0 ? s.dt : s.frame_start + s.dt - time_of(s, s.number); }

FrameArguments frame_arguments(const Substep& s, int object) {
  const int first = s.model.first_frame[object];
  return {s.state.frames.orientations.data() + first, s.state.frames.inverse_inertias.data() + first,
          s.work.frames.starts.data() + first, s.work.frames.predicted.data() + first,
          s.work.frames.corrections.data() + first};
}

AdvanceArguments particles(const Substep& s, int task) {
  AdvanceArguments a = object_particles(s, s.model.tiles()[task].object);
  const Tile& tile = tile_of(s, task);
  a.first = tile.first_particle;
  a.last = tile.last_particle;
  return a;
}

AdvanceArguments object_particles(const Substep& s, int object) {
  const int first = s.model.first[object];
  const FrameGravity& gravity = s.work.gravity[object];
  AdvanceArguments a;
  a.positions = s.state.positions.data() + first;
  a.displacements = s.work.displacements.data() + first;
  a.remainders = s.state.remainders.data() + first;
  a.velocities = s.state.velocities.data() + first;
  a.last = s.model.objects[object].particles;
  a.h = s.h;
  a.inverse_h = 1 / s.h;
  a.velocity_kept = gravity.kept;
  a.gravity_step = s.model.gravity * s.h;
  a.gravity_finished = gravity_for(s, gravity.finished);
  a.gravity_begun = gravity_for(s, gravity.begun);
  return a;
}

PairParticles all_particles(const Substep& s) {
  return {s.state.positions.data(), s.state.remainders.data(), s.work.displacements.data(), s.h,
          s.state.births.empty() ? nullptr : s.state.births.data()};
}

void for_tiles(Substep& s, const char* name, FunctionRef<void(int)> body) {
  if (s.part == nullptr) return s.context.executor.parallel_for(name, static_cast<int>(s.model.tiles().size()), body);
  const std::vector<int>& tiles = s.part->tiles;
  s.context.executor.parallel_for(name, static_cast<int>(tiles.size()), [&](int i) { body(tiles[i]); });
}

void for_swept_tiles(Substep& s, const char* name, FunctionRef<void(int)> body) {
  for_tiles(s, name, [&](int task) {
    if (is_swept(s, s.model.tiles()[task].object)) body(task);
  });
}

void for_tasks(Substep& s, const char* name, int tasks, FunctionRef<void(int)> body) {
  s.context.executor.parallel_for(name, tasks, body);
}

}  // namespace pliant
