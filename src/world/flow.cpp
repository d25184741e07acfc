// A particle that goes keeps its place, without mass and speed, until an emitter takes it: the one with the lowest
// number first. So which particles are there follows from the State alone.
#include "world/flow.h"

#include <algorithm>
#include <cmath>

#include "collision/narrow/contact.h"
#include "core/at.h"
#include "geometry/shapes.h"
#include "math/motion.h"
#include "math/record.h"
#include "world/particles.h"
#include "world/resting_grains.h"

namespace pliant {

namespace {

/// An opening holds so many layers behind it, which move as it says and cannot be pushed back. Where they could be,
/// each layer pushed back the next one farther, and jets blew up within ten layers.
constexpr double held_layers = 2;

/// Takes a particle away.
void remove(State& state, std::size_t particle) {
  state.positions[particle].w = 0;
  state.velocities[particle] = {};
  state.remainders[particle] = {};
  state.births[particle] = not_there;
}

/// Calls body(particle) for the particles of an object that are there.
template <class Body>
void for_present(const WorldData& world, int number, const Body& body) {
  const int first = world.model.first[number], last = first + world.model.objects[at(number)].user_particles;
  for (int i = first; i < last; ++i)
    if (world.state.births[at(i)] != not_there) body(at(i));
}

/// Calls body(particle) for those of them that can move: what a user has fixed stays.
template <class Body>
void for_free(const WorldData& world, int number, const Body& body) {
  for_present(world, number, [&](std::size_t i) {
    if (own_inverse_mass(world.model, number, static_cast<std::int64_t>(i)) > 0) body(i);
  });
}

void expire(WorldData& world, int number, FlowReport& report) {
  const auto lifetime = static_cast<double>(world.model.objects[at(number)].flow.lifetime);
  if (!(lifetime > 0)) return;
  for_free(world, number, [&](std::size_t i) {
    if (world.state.time - world.state.births[i] < lifetime) return;
    remove(world.state, i);
    ++report.expired;
  });
}

void drain(WorldData& world, int number, FlowReport& report) {
  for (const Drain& drain : world.model.objects[at(number)].flow.drains) {
    const LocalShape shape = local_shape(drain.shape);
    const Posed pose{convert<double>(drain.position), normalise(convert<double>(drain.rotation))};
    for_free(world, number, [&](std::size_t i) {
      const Vec3f local = convert<float>(to_local(pose, convert<double>(xyz(world.state.positions[i]))));
      if (!(signed_distance(shape, local).distance < 0)) return;
      remove(world.state, i);
      ++report.drained;
    });
  }
}

/// Frees what has passed its opening, where it was from then on in free fall.
void release(WorldData& world, int number) {
  State& state = world.state;
  const float* const rest_times = grain_rest_times(state);
  for_free(world, number, [&](std::size_t i) {
    const bool sleeps = rest_times != nullptr && rest_times[i] == asleep;
    if (state.positions[i].w > 0 || state.births[i] > state.time || sleeps) return;
    const auto since = static_cast<float>(state.time - state.births[i]);
    const Vec3f gravity = world.model.gravity, moved = gravity * (since * since / 2), gained = gravity * since;
    Record &x = state.positions[i], &v = state.velocities[i];
    x = {x.x + moved.x, x.y + moved.y, x.z + moved.z,
         own_inverse_mass(world.model, number, static_cast<std::int64_t>(i))};
    v = {v.x + gained.x, v.y + gained.y, v.z + gained.z, 0};
  });
}

/// Forgets contacts of grains that are no longer there, since others will have their numbers.
void forget_contacts_of_gone(State& state) {
  std::erase_if(state.grain_contacts,
                [&](const GrainContact& c) { return !is_there(state, at(c.a)) || !is_there(state, at(c.b)); });
}

/// How many layers leave in a second.
double rate_of(const EmitterLayer& layer) {
  return static_cast<double>(layer.speed) / static_cast<double>(layer.distance);
}

/// How many layers of an emitter have left by a time: none after its end, and the nearest whole number to what flows
/// until then.
std::int64_t layers_by(const Emitter& emitter, const EmitterLayer& layer, double time) {
  constexpr double most = 1e12;  // so that their particles can be counted
  const double since = std::min(time, static_cast<double>(emitter.end)) - static_cast<double>(emitter.start);
  return static_cast<std::int64_t>(std::clamp(since * rate_of(layer) + 0.5, 0.0, most));
}

/// The time at which a layer leaves: in the middle of its share of the flow [s].
double time_of_layer(const Emitter& emitter, const EmitterLayer& layer, std::int64_t number) {
  return static_cast<double>(emitter.start) + (static_cast<double>(number) + 0.5) / rate_of(layer);
}

EmittedLayers& emitted_by(State& state, int block, int emitter) {
  const EmittedLayers wanted{block, emitter, 0};
  const auto found = std::lower_bound(state.emitted.begin(), state.emitted.end(), wanted, in_order_of_emitters);
  if (found != state.emitted.end() && found->block == block && found->emitter == emitter) return *found;
  return *state.emitted.insert(found, wanted);
}

/// A number from -1 to 1 that is another one for each seed.
float noise(std::uint64_t seed) {
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9ULL;  // splitmix64
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<float>(static_cast<std::int32_t>((seed ^ (seed >> 31)) >> 40) - (1 << 23)) * 0x1p-23f;
}

/// Adds the layers of one emitter of an object.
class EmitterRun {
 public:
  EmitterRun(WorldData& world, int number, int emitter, double dt)
      : world_(world),
        state_(world.state),
        object_(world.model.objects[at(number)]),
        emitter_(object_.flow.emitters[at(emitter)]),
        layer_(object_.layers[at(emitter)]),
        first_(world.model.first[number]),
        next_(first_),
        dt_(dt) {
    const double lead = held_layers / rate_of(layer_);
    EmittedLayers& emitted = emitted_by(state_, number, emitter);
    // An edit may have changed the rate, so that the number says another time. Those of before the emitter was there
    // are left out.
    const std::int64_t held = layers_by(emitter_, layer_, state_.time + lead);
    begin_ = std::max(std::min(emitted.layers, held), layers_by(emitter_, layer_, state_.time));
    emitted.layers = end_ = std::max(layers_by(emitter_, layer_, state_.time + dt + lead), begin_);
  }

  void emit(FlowReport& report) {
    if (begin_ == end_) return;
    find_near();
    std::int64_t layer = begin_;
    const std::int64_t last = std::min(end_, begin_ + object_.user_particles);  // no more can find room
    for (; layer < last && find_spare(); ++layer) emit_layer(layer, report);
    report.refused += (end_ - layer) * static_cast<std::int64_t>(layer_.places.size());
  }

 private:
  struct Opening {
    Vec3f centre{}, velocity{};
    Quatf turn{};
  };

  /// The opening as a layer passes it, and the velocity with which it does.
  Opening opening_at(double time) const {
    const Posed pose = pose_at(emitter_.motion, time), later = pose_at(emitter_.motion, time + dt_);
    Opening opening;
    opening.centre = carried(pose, emitter_.position);
    opening.turn = convert<float>(pose.rotation);
    const Vec3f along = emitter_.direction * (1 / sqrt(length_squared(emitter_.direction)));
    const Vec3f moves = (carried(later, emitter_.position) - opening.centre) * static_cast<float>(1 / dt_);
    opening.velocity = rotate(opening.turn, along) * layer_.speed + moves;
    return opening;
  }

  /// Finds the first particle that is not there. They are used in ascending order.
  bool find_spare() {
    const int last = first_ + object_.user_particles;
    while (next_ < last && state_.births[at(next_)] != not_there) ++next_;
    return next_ < last;
  }

  /// Lists the particles that are where layers may be put.
  void find_near() {
    float radius = 0;
    for (const Vec3f& place : layer_.places) radius = std::max(radius, length_squared(place));
    const auto dt = static_cast<float>(dt_);
    const Opening opening = opening_at(state_.time);
    const float way =
        (sqrt(length_squared(opening.velocity)) + sqrt(length_squared(world_.model.gravity)) * dt) * 2 * dt;
    const float reach = sqrt(radius) + way + 2 * layer_.distance;
    for (int i = first_; i < first_ + object_.user_particles; ++i) {
      const Vec3f place = xyz(state_.positions[at(i)]);
      if (state_.births[at(i)] != not_there && length_squared(place - opening.centre) < reach * reach)
        near_.push_back(place);
    }
  }

  bool is_blocked(const Vec3f& place) const {
    const float least = object_.emitted_size * object_.emitted_size;
    return std::any_of(near_.begin(), near_.end(), [&](const Vec3f& p) { return length_squared(p - place) < least; });
  }

  /// Puts a layer to where it falls from to pass the opening at its time.
  void emit_layer(std::int64_t layer, FlowReport& report) {
    const double time = time_of_layer(emitter_, layer_, layer);
    const Opening opening = opening_at(time);
    const auto left = static_cast<float>(time - state_.time);
    const Vec3f velocity = opening.velocity, back = velocity * left;
    for (std::size_t i = 0; i < layer_.places.size(); ++i) {
      const Vec3f place = opening.centre + rotate(opening.turn, layer_.places[i]) - back + shift(layer, i);
      if (!find_spare()) {  // counts as refused whatever is in its way, as do whole layers in `emit`
        ++report.refused;
      } else if (is_blocked(place)) {
        ++report.blocked;
      } else {
        put(at(next_), place, velocity, time);
        ++report.emitted;
      }
    }
  }

  Vec3f shift(std::int64_t layer, std::size_t place) const {
    const float size = object_.emitted_jitter;
    if (size == 0) return {};
    const std::uint64_t seed = (static_cast<std::uint64_t>(layer) * layer_.places.size() + place + 1) * 3;
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
    return Vec3f{noise(seed * golden), noise((seed + 1) * golden), noise((seed + 2) * golden)} * size;
  }

  void put(std::size_t particle, const Vec3f& place, const Vec3f& velocity, double time) {
    state_.positions[particle] = {place.x, place.y, place.z, 0};  // until it has passed the opening
    state_.velocities[particle] = {velocity.x, velocity.y, velocity.z, 0};
    state_.remainders[particle] = {};
    state_.births[particle] = time;
  }

  WorldData& world_;
  State& state_;
  const CompiledObject& object_;
  const Emitter& emitter_;
  const EmitterLayer& layer_;
  int first_, next_;
  double dt_;
  std::int64_t begin_ = 0, end_ = 0;  ///< layers to emit
  std::vector<Vec3f> near_;
};

}  // namespace

void let_flow(WorldData& world, double dt, FlowReport& report) {
  if (world.state.births.empty()) return;
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    const Flow& flow = world.model.objects[at(number)].flow;
    if (!flow.is_used()) continue;
    release(world, number);
    expire(world, number, report);
    drain(world, number, report);
  }
  if (report.expired + report.drained > 0) {
    wake_beside_gone(world);
    forget_contacts_of_gone(world.state);
  }
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    const Flow& flow = world.model.objects[at(number)].flow;
    if (!flow.is_used()) continue;
    for (int emitter = 0; emitter < static_cast<int>(flow.emitters.size()); ++emitter)
      EmitterRun(world, number, emitter, dt).emit(report);
  }
  if (report.emitted > 0) world.workspace.look_for_tangles = true;  // lists of surfaces hold while nothing jumps
}

void follow_pressures(WorldData& world, double time) {
  for (CompiledObject& object : world.model.objects)
    if (object.has_volume && object.volume.described.changes()) object.volume.target = object.volume.target_at(time);
}

std::int64_t count_present(const WorldData& world) {
  std::int64_t count = 0;
  if (world.state.births.empty()) return count;
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number)
    if (world.model.objects[at(number)].flow.is_used()) for_present(world, number, [&](std::size_t) { ++count; });
  return count;
}

}  // namespace pliant
