#include "solver/diagnose.h"

#include <algorithm>
#include <optional>

#include "constraints/registry.h"
#include "solver/points.h"
#include "solver/stencil.h"

namespace pliant {

namespace {

/// Describes a constraint: "distance constraint 17 (particles 3, 4)", with the user's indices.
std::string describe(const CompiledObject& object, const Pool& pool, const Segment& segment, int batch, int lane) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset + batch * indices_per_batch(pool, segment);
  std::string particles;
  for (int slot = 0; slot < pool.stencil; ++slot) {
    const int number = particle_of(segment, index, slot, lane);
    if (number >= object.particles) {
      particles += (slot == 0 ? "frame " : ", frame ") + std::to_string(number - object.particles);
      continue;
    }
    const int user = object.order[number];
    particles +=
        (slot == 0 ? "" : ", ") + (user < object.user_particles
                                       ? std::to_string(user)
                                       : "target of attachment " + std::to_string(user - object.user_particles));
  }
  const int constraint = pool.origin[static_cast<std::size_t>(segment.first_batch + batch) * batch_width + lane];
  return constraint_type(pool.type).name + " constraint " + std::to_string(constraint) + " (particles " + particles +
         ")";
}

/// Describes the first constraint of a segment that has a non-finite particle; nullopt if there is none.
std::optional<std::string> find_culprit(const CompiledObject& object, const Segment& segment, const Record* positions) {
  const Pool& pool = object.pools[segment.pool];
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, batch, lane)) continue;
      for (int slot = 0; slot < pool.stencil; ++slot) {
        const int particle = particle_of(segment, index, slot, lane);
        if (particle < object.particles && !is_finite(positions[particle]))
          return describe(object, pool, segment, batch, lane);
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> replay(const StepContext& context, const CompiledObject& object, int first, int last,
                                  SweepArguments arguments) {
  for (int s = first; s < last; ++s) {
    context.kernels.sweep(object.pools.data(), &object.segments[s], &object.segments[s] + 1, arguments);
    if (auto culprit = find_culprit(object, object.segments[s], arguments.displacements)) return culprit;
  }
  return std::nullopt;
}

/// Replays the stencil segments of an object from the orientations that the failed substep left, and describes the
/// first constraint that makes a value non-finite.
std::optional<std::string> replay_stencils(const StepContext& context, const CompiledObject& object,
                                           const ObjectPhase& colour, const SweepArguments& arguments) {
  const auto number = static_cast<std::size_t>(&object - context.model.objects.data());
  const int first = context.model.first_frame[number], last = context.model.end_of_frames(static_cast<int>(number));
  FrameRecords& all = context.state.frames;
  Records orientations(all.orientations.begin() + first, all.orientations.begin() + last), none(orientations.size());
  for (Record& q : orientations) q = is_finite(q) && q.w - q.w == 0 ? q : Record{0, 0, 0, 1};
  for (int s = colour.first; s < colour.last; ++s) {
    Records corrections(orientations.size());
    project_segment(object, object.segments[s], arguments,
                    {orientations.data(), all.inverse_inertias.data() + first, orientations.data(), none.data(),
                     corrections.data()});
    if (auto culprit = find_culprit(object, object.segments[s], arguments.displacements)) return culprit;
  }
  return std::nullopt;
}

/// Replays one phase of an object and describes the first faulty constraint. Returns nullopt for tiles, which are
/// replayed one by one, and for drivers that can name no constraint.
std::optional<std::string> replay_phase(const StepContext& context, const CompiledObject& object,
                                        const ObjectPhase& phase, const SweepArguments& arguments) {
  if (phase.driver == Driver::inter_tile) return replay(context, object, phase.first, phase.last, arguments);
  if (phase.driver == Driver::stencil) return replay_stencils(context, object, phase, arguments);
  if (phase.driver != Driver::chain) return std::nullopt;
  for (int batch = phase.first; batch < phase.last; ++batch) {
    const ChainBatch& chain = object.chains[batch];
    const int last = chain.first_segment + chain.steps;
    if (auto culprit = replay(context, object, chain.first_segment, last, arguments)) return culprit;
  }
  return std::nullopt;
}

/// A particle, or the body whose centre it is.
std::string words_of_particle(const CompiledObject& object, int i) {
  const auto& bodies = object.bodies.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].particle == i) return words_of_body(object.bodies, static_cast<int>(b), object.name);
  return "particle " + std::to_string(object.order[i]);
}

std::string first_bad_particle(const CompiledObject& object, const Tile& tile, const Record* displacements) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    if (!is_finite(displacements[i])) return words_of_particle(object, i);
  }
  return "a particle";
}

/// The tasks of the tiles with non-finite values, for the first object of the group that has any.
std::vector<int> bad_tasks(const Substep& s) {
  const std::vector<Task>& tiles = s.model.tiles();
  std::vector<int> bad;
  for_each_tile(s, [&](int task) {
    if (s.work.tiles[task].finite) return;
    if (bad.empty() || tiles[task].object == tiles[bad.front()].object) bad.push_back(task);
  });
  return bad;
}

/// Describes the origin of non-finite values in the given tiles of one object. The tiles are replayed together, because
/// a faulty inter-tile constraint makes all tiles of its particles non-finite.
std::string explain(const Substep& s, const CompiledObject& object, const std::vector<int>& bad,
                    SweepArguments arguments) {
  const StepContext& context = s.context;
  const std::string particle = first_bad_particle(object, tile_of(s, bad.front()), arguments.displacements);
  Records displacements(arguments.displacements, arguments.displacements + object.particles);
  for (int task : bad) {
    AdvanceArguments again = particles(s, task);
    again.displacements = displacements.data();
    again.gravity_begun = again.gravity_finished;  // the gravity of the failed substep
    context.kernels.predict(again, nullptr);
    for (int i = again.first; i < again.last; ++i) {
      if (is_finite(displacements[i])) continue;
      return words_of_particle(object, i) + " (its velocity or the force on it is too large)";
    }
  }
  arguments.displacements = displacements.data();
  arguments.skipped = nullptr;  // joints that are solved directly are replayed one by one
  for (int iteration = 0; iteration < context.iterations; ++iteration) {
    arguments.first_pass = iteration == 0;
    for (int task : bad) {
      const Tile& tile = tile_of(s, task);
      if (auto culprit = replay(context, object, tile.first_segment, tile.last_segment, arguments)) return *culprit;
    }
    for (const ObjectPhase& phase : object.phases) {
      if (auto culprit = replay_phase(context, object, phase, arguments)) return *culprit;
    }
  }
  return object.has_volume ? "volume constraint (first non-finite value at " + particle + ")" : particle;
}

bool is_finite_orientation(const Record& r) { return is_finite(r) && r.w - r.w == 0; }

/// Completes the description with the first frame (orientation) that is not finite.
void name_bad_frame(const StepContext& context, NonFinite& found) {
  const FrameRecords& frames = context.state.frames;
  for (std::size_t o = 0; o < context.model.objects.size(); ++o) {
    for (int i = context.model.first_frame[o]; i < context.model.end_of_frames(static_cast<int>(o)); ++i) {
      if (is_finite_orientation(frames.orientations[i]) && is_finite(frames.angular_velocities[i])) continue;
      found.object = context.model.objects[o].name;
      found.element = "frame " + std::to_string(i - context.model.first_frame[o]);
      return;
    }
  }
}

/// Replaces non-finite values of the State: displacements, velocities and residues by zero, orientations by the
/// identity.
void make_finite(const StepContext& context) {
  for (Record& d : context.workspace.displacements) d = is_finite(d) ? d : Record{};
  for (Record& v : context.state.velocities) v = is_finite(v) ? v : Record{};
  for (Record& r : context.state.remainders) r = is_finite(r) ? r : Record{};
  for (Record& q : context.state.frames.orientations) q = is_finite_orientation(q) ? q : Record{0, 0, 0, 1};
  for (Record& w : context.state.frames.angular_velocities) w = is_finite(w) ? w : Record{};
}

}  // namespace

NonFinite diagnose(const Substep& s) {
  const StepContext& context = s.context;
  NonFinite found;
  const std::vector<int> bad = bad_tasks(s);
  if (!bad.empty()) {
    const int number = context.model.tiles()[bad.front()].object;
    found.object = context.model.objects[number].name;
    found.element = explain(s, context.model.objects[number], bad, arguments(s, number, true));
  }
  if (bad.empty()) name_bad_frame(context, found);
  make_finite(context);
  return found;
}

}  // namespace pliant
