#include "solver/diagnose.h"

#include <algorithm>
#include <optional>

#include "constraints/all.h"
#include "solver/points.h"

namespace pliant {

namespace {

std::string type_name(int type) {
  std::string name;
  with_type(AllConstraints{}, type, [&](auto tag) { name = decltype(tag)::type::name; });
  return name;
}

/// "distance constraint 17 (particles 3, 4)", in the user's numbering.
std::string describe(const CompiledObject& object, const Pool& pool, const Segment& segment, int batch, int lane) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset + batch * indices_per_batch(pool, segment);
  std::string particles;
  for (int slot = 0; slot < pool.stencil; ++slot) {
    const int user = object.order[particle_of(segment, index, slot, lane)];
    particles += (slot == 0 ? "" : ", ") + (user < object.user_particles
                                                ? std::to_string(user)
                                                : "target of attachment " + std::to_string(user - object.user_particles));
  }
  const int number = pool.origin[static_cast<std::size_t>(segment.first_batch + batch) * batch_width + lane];
  return type_name(pool.type) + " constraint " + std::to_string(number) + " (particles " + particles + ")";
}

/// The first constraint of a segment with a particle that is not finite.
std::optional<std::string> find_culprit(const CompiledObject& object, const Segment& segment, const Record* positions) {
  const Pool& pool = object.pools[segment.pool];
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, batch, lane)) continue;
      for (int slot = 0; slot < pool.stencil; ++slot) {
        if (!is_finite(positions[particle_of(segment, index, slot, lane)]))
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

std::string first_bad_particle(const CompiledObject& object, const Tile& tile, const Record* displacements) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    if (!is_finite(displacements[i])) return "particle " + std::to_string(object.order[i]);
  }
  return "a particle";
}

/// The tasks of the first object that has tiles which are not finite.
std::vector<int> bad_tasks(const StepContext& context) {
  const Model& model = context.model;
  std::vector<int> bad;
  for (int task = 0; task < static_cast<int>(model.tiles.size()); ++task) {
    if (context.workspace.tiles[task].finite) continue;
    if (bad.empty() || model.tiles[task].object == model.tiles[bad.front()].object) bad.push_back(task);
  }
  return bad;
}

/// The name of what went wrong in the tiles of one object that are not finite. They are replayed together, since an
/// inter-tile constraint needs both tiles as they were: one that makes its particles non-finite spoils each of their tiles.
std::string explain(const Substep& s, const CompiledObject& object, const std::vector<int>& bad, SweepArguments arguments) {
  const StepContext& context = s.context;
  const std::string particle = first_bad_particle(object, tile_of(s, bad.front()), arguments.displacements);
  Records displacements(arguments.displacements, arguments.displacements + object.particles);
  for (int task : bad) {
    AdvanceArguments again = particles(s, task);
    again.displacements = displacements.data();
    again.gravity_begun = again.gravity_finished;  // the substep that failed, not the one after it
    context.kernels.predict(again, nullptr);
    for (int i = again.first; i < again.last; ++i) {
      if (is_finite(displacements[i])) continue;
      return "particle " + std::to_string(object.order[i]) + " (its velocity or the force on it is too large)";
    }
  }
  arguments.displacements = displacements.data();
  for (int iteration = 0; iteration < context.iterations; ++iteration) {
    arguments.first_pass = iteration == 0;
    for (int task : bad) {
      const Tile& tile = tile_of(s, task);
      if (auto culprit = replay(context, object, tile.first_segment, tile.last_segment, arguments)) return *culprit;
    }
    for (const StraddlerColour& colour : object.straddlers) {
      if (auto culprit = replay(context, object, colour.first_segment, colour.last_segment, arguments)) return *culprit;
    }
    for (const ChainBatch& chain : object.chains) {
      const int last = chain.first_segment + chain.steps;
      if (auto culprit = replay(context, object, chain.first_segment, last, arguments)) return *culprit;
    }
  }
  return object.has_volume ? "volume constraint (seen at " + particle + ")" : particle;
}

/// Finite again: no displacement, no velocity where there is no number.
void make_finite(const StepContext& context) {
  for (Record& d : context.workspace.displacements) d = is_finite(d) ? d : Record{};
  for (Record& v : context.state.velocities) v = is_finite(v) ? v : Record{};
  for (Record& r : context.state.remainders) r = is_finite(r) ? r : Record{};
}

}  // namespace

NonFinite diagnose(const Substep& s) {
  const StepContext& context = s.context;
  NonFinite found;
  const std::vector<int> bad = bad_tasks(context);
  if (!bad.empty()) {
    const int number = context.model.tiles[bad.front()].object;
    found.object = context.model.objects[number].name;
    found.element = explain(s, context.model.objects[number], bad, arguments(s, number, true));
  }
  make_finite(context);
  return found;
}

}  // namespace pliant
