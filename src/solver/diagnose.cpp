#include "solver/diagnose.h"

#include <algorithm>
#include <optional>

#include "constraints/all.h"

namespace pliant {

namespace {

bool is_finite(const Record& r) { return (r.x - r.x) + (r.y - r.y) + (r.z - r.z) == 0; }

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
    if (auto culprit = find_culprit(object, object.segments[s], arguments.positions)) return culprit;
  }
  return std::nullopt;
}

std::string first_bad_particle(const CompiledObject& object, const Tile& tile, const Record* positions) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    if (!is_finite(positions[i])) return "particle " + std::to_string(object.order[i]);
  }
  return "a particle";
}

/// The name of what went wrong in the tiles of one object that are not finite. They are replayed together, since what
/// straddles two of them needs both as they were: a constraint that spoils its particles spoils every tile they are in.
std::string explain(const StepContext& context, const CompiledObject& object, const std::vector<const Tile*>& bad,
                    SweepArguments arguments) {
  const std::string particle = first_bad_particle(object, *bad.front(), arguments.positions);
  std::vector<Record> positions(arguments.positions, arguments.positions + object.particles);
  for (const Tile* tile : bad) {
    for (int i = tile->first_particle; i < tile->last_particle; ++i) {
      if (!is_finite(arguments.predicted[i])) {
        return "particle " + std::to_string(object.order[i]) + " (its velocity or the force on it is too large)";
      }
      positions[i] = arguments.predicted[i];
    }
  }
  arguments.positions = positions.data();
  for (int iteration = 0; iteration < context.iterations; ++iteration) {
    arguments.first_pass = iteration == 0;
    for (const Tile* tile : bad) {
      if (auto culprit = replay(context, object, tile->first_segment, tile->last_segment, arguments)) return *culprit;
    }
    for (const StraddlerColour& colour : object.straddlers) {
      if (auto culprit = replay(context, object, colour.first_segment, colour.last_segment, arguments)) return *culprit;
    }
  }
  return object.has_volume ? "volume constraint (seen at " + particle + ")" : particle;
}

/// The tiles of the first object that has some which are not finite.
std::vector<const Tile*> bad_tiles(const StepContext& context, int& object) {
  const Model& model = context.model;
  std::vector<const Tile*> bad;
  for (std::size_t task = 0; task < model.tiles.size(); ++task) {
    if (context.workspace.tiles[task].finite) continue;
    if (bad.empty()) object = model.tiles[task].object;
    if (object == model.tiles[task].object) bad.push_back(&model.objects[object].tiles[model.tiles[task].tile]);
  }
  return bad;
}

void put_back(const CompiledObject& object, const Tile& tile, const SweepArguments& a) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    const Record &q = a.predicted[i], &v = a.velocities[i];
    const Record start{q.x - a.h * v.x, q.y - a.h * v.y, q.z - a.h * v.z, q.w};
    a.positions[i] = is_finite(start) ? start : object.positions[i];
  }
}

void stop_what_is_not_finite(State& state) {
  for (Record& v : state.velocities) v = is_finite(v) ? v : Record{};
  for (Record& r : state.remainders) r = is_finite(r) ? r : Record{};
}

}  // namespace

NonFinite diagnose(const StepContext& context, FunctionRef<SweepArguments(int)> arguments) {
  NonFinite found;
  const Model& model = context.model;
  int number = 0;
  const std::vector<const Tile*> bad = bad_tiles(context, number);
  if (bad.empty()) return found;
  found.object = model.objects[number].name;
  found.element = explain(context, model.objects[number], bad, arguments(number));
  for (std::size_t task = 0; task < model.tiles.size(); ++task) {
    if (context.workspace.tiles[task].finite) continue;
    const CompiledObject& object = model.objects[model.tiles[task].object];
    put_back(object, object.tiles[model.tiles[task].tile], arguments(model.tiles[task].object));
  }
  stop_what_is_not_finite(context.state);
  return found;
}

}  // namespace pliant
