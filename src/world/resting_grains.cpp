#include "world/resting_grains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "collision/broad/tree.h"
#include "core/at.h"
#include "geometry/polyhedron.h"
#include "math/motion.h"
#include "math/record.h"
#include "model/surface_velocity.h"
#include "solver/grains/grain_solver.h"
#include "world/control.h"
#include "world/particles.h"

namespace pliant {

namespace {

/// A grain is slow if it moves by less than this share of its radius in SleepOptions::time, and slower than
/// SleepOptions::speed. A grain or what it meets has to move so many times as fast to wake it.
constexpr float slow_share = 0.1f, wake_factor = 5;

/// The values of a channel; null if there is none of this name.
std::vector<float>* find_channel(State& state, const char* name) {
  for (Channel& channel : state.channels)
    if (channel.name == name) return &channel.values;
  return nullptr;
}

/// Adds a channel if there is none of this name. Channels are ordered by name.
void make_channel(State& state, const char* name) {
  if (find_channel(state, name) != nullptr) return;
  const auto before =
      std::find_if(state.channels.begin(), state.channels.end(), [&](const Channel& one) { return one.name > name; });
  state.channels.insert(before, {name, 1, std::vector<float>(state.positions.size(), 0.f)});
}

/// What the State keeps of rest: for each particle of it, how long it has been slow, and how far what is near it has
/// moved since it sleeps.
struct Rest {
  std::vector<float>*times = nullptr, *shifts = nullptr;
  explicit operator bool() const { return times != nullptr && shifts != nullptr; }
};

Rest rest_of(State& state) { return {find_channel(state, rest_time_channel), find_channel(state, rest_shift_channel)}; }

/// True if grains of an object may sleep. What holds some together could not move those that sleep.
bool may_sleep(const CompiledObject& object) {
  return object.grains && object.clusters.clusters.empty() && object.segments.empty() &&
         object.particles == object.user_particles;
}

bool any_may_sleep(const Model& model) { return std::any_of(model.objects.begin(), model.objects.end(), may_sleep); }

/// Calls body(number, particle) for all grains that are there and not fixed by the user.
template <class Body>
void for_grains(const WorldData& world, const Body& body) {
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    if (!may_sleep(world.model.objects[at(number)])) continue;
    for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i)
      if (is_there(world.state, at(i)) && own_inverse_mass(world.model, number, i) > 0) body(number, i);
  }
}

float slow_speed(const WorldData& world, int number) {
  const SleepOptions& sleep = world.settings.sleep;
  return std::min(sleep.speed,
                  slow_share * world.model.objects[at(number)].grains->radius / std::max(sleep.time, 0.01f));
}

void wake(WorldData& world, const Rest& rest, int number, int particle) {
  (*rest.times)[at(particle)] = (*rest.shifts)[at(particle)] = 0;
  if (!is_there(world.state, at(particle))) return;
  world.state.positions[at(particle)].w = own_inverse_mass(world.model, number, particle);
}

// ---------------------------------------------------------------- what moves near grains

float bounding_radius(const ConvexShape& shape) {
  float core = shape.half_length;
  if (shape.core_radius > 0) core = std::sqrt(core * core + shape.core_radius * shape.core_radius);
  if (shape.polyhedron != nullptr)
    for (const Vec3f& corner : shape.polyhedron->corners) core = std::max(core, length(corner));
  return core + shape.radius;
}

/// The speed at which what no grain can stop counts, so that grains near it may not sleep [m/s].
constexpr float unstoppable = std::numeric_limits<float>::infinity();

/// Boxes around all that moves and may touch grains.
class Movers {
 public:
  Movers(const WorldData& world, double dt) : world_(world), dt_(dt) {
    for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number)
      if (world.model.objects[at(number)].grains)
        least_fast_ = std::min(least_fast_, wake_factor * slow_speed(world, number));
    for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) add_object(number);
    for (int number = 0; number < static_cast<int>(world.model.colliders.size()); ++number) add_collider(number);
    if (!boxes_.empty()) tree_.build(boxes_);
  }

  /// The largest speed near a grain of an object [m/s]. Other grains and liquids, which never come to rest completely,
  /// count only if they are fast, and then as `unstoppable`.
  float speed_near(int number, const Vec3f& place) const {
    if (everywhere_) return unstoppable;
    const CompiledObject& grains = world_.model.objects[at(number)];
    const float fast = wake_factor * slow_speed(world_, number);
    float speed = 0;
    if (boxes_.empty()) return speed;
    tree_.query(BoxBounds::of(&place, 1).grown(3 * grains.grains->radius), [&](int box) {
      const Mover& mover = movers_[at(box)];
      if (mover.object >= 0 && mover.object != number && !masks_meet(world_.model.objects[at(mover.object)], grains))
        return;
      const float of_mover = !mover.is_never_still ? mover.speed : mover.speed > fast ? unstoppable : 0;
      speed = std::max(speed, of_mover);
    });
    return speed;
  }

 private:
  struct Mover {
    int object = -1;  ///< -1: a collider
    float speed = 0;
    bool is_never_still = false;  ///< a grain or liquid
  };

  void add(const BoxBounds& box, float margin, const Mover& mover) {
    const float way = mover.speed < unstoppable ? 2 * mover.speed * static_cast<float>(dt_) : 0;
    boxes_.push_back(box.grown(margin + way));
    movers_.push_back(mover);
  }
  void add(const Vec3f& place, float margin, const Mover& mover) { add(BoxBounds::of(&place, 1), margin, mover); }

  void add_object(int number) {
    const CompiledObject& object = world_.model.objects[at(number)];
    if (object.particles == 0 || object.tracers) return;
    if (object.is_collider) return add_mesh(number, object);
    if (object.grains || object.fluid) return add_each(number, object);
    if (!object.bodies.empty()) add_bodies(number, object);
    add_particles(number, object);
  }

  float speed_of(int particle) const { return length(xyz(world_.state.velocities[at(particle)])); }

  /// Grains and liquids, each by itself.
  void add_each(int number, const CompiledObject& object) {
    const int first = world_.model.first[at(number)];
    const bool moves = is_driven(number, object);
    for (int i = first; i < first + object.user_particles; ++i) {
      if (!is_there(world_.state, at(i))) continue;
      const float speed = speed_of(i), size = object.grains ? object.grains->radius : object.thickness;
      const bool is_held = !(world_.state.positions[at(i)].w > 0);  // by an opening, a pin or the user, or it sleeps
      if (is_held && (speed > 0 || (moves && !(own_inverse_mass(world_.model, number, i) > 0))))
        add(xyz(world_.state.positions[at(i)]), size + speed * static_cast<float>(dt_), {number, unstoppable});
      else if (speed > least_fast_)
        add(xyz(world_.state.positions[at(i)]), size, {number, speed, true});
    }
  }

  /// True if a motion does something in the step.
  bool changes(const Motion& motion) const {
    if (!motion.moves()) return false;
    const Posed now = pose_at(motion, world_.state.time), then = pose_at(motion, world_.state.time + dt_);
    return length_squared(then.position - now.position) > 0 || std::abs(dot(then.rotation, now.rotation)) < 1;
  }

  /// True if the user, a pin, a motor, or keyframes of pressure or rest data move an object.
  bool is_driven(int number, const CompiledObject& object) const {
    const double now = world_.state.time, then = now + dt_;
    return world_.workspace.control.object(number) != nullptr ||
           (object.has_volume && object.volume.described.changes()) ||
           std::any_of(object.joints.begin(), object.joints.end(),
                       [](const CompiledJoint& joint) { return !joint.motors.empty(); }) ||
           std::any_of(object.changing.scaled.begin(), object.changing.scaled.end(),
                       [&](const ScaledGroup& group) { return group.factor_at(now) != group.factor_at(then); }) ||
           std::any_of(object.kinematics.begin(), object.kinematics.end(),
                       [&](const Kinematic& one) { return changes(one.motion); });
  }

  /// Boxes around all particles of a mesh collider that moves, before and after the step.
  void add_mesh(int number, const CompiledObject& mesh) {
    const PoseDrive* const drive = world_.workspace.control.mesh(number);
    const bool is_set = drive != nullptr && drive->moves(),
               slides = surface_velocity_of_mesh(world_.model, world_.workspace.control, number, world_.state.time) !=
                        Vec3f{};
    if (!is_set && !slides && (drive != nullptr || !(changes(mesh.carrier.motion) || mesh.carrier.deforms()))) return;
    const double then = world_.state.time + dt_;
    const CarrierPose after = is_set ? CarrierPose(mesh.carrier, then, drive->to) : CarrierPose(mesh.carrier, then);
    const int first = world_.model.first[at(number)];
    std::vector<Vec3f> places;
    for (int i = 0; i < mesh.particles; ++i) {
      places.push_back(xyz(world_.state.positions[at(first + i)]));
      places.push_back(convert<float>(after.place(i)));
    }
    add(BoxBounds::of(places.data(), static_cast<int>(places.size())), mesh.thickness, {number, unstoppable});
  }

  /// One box around the particles of an object, if some of them move.
  void add_particles(int number, const CompiledObject& object) {
    const int first = world_.model.first[at(number)];
    std::vector<Vec3f> places;
    float speed = is_driven(number, object) ? unstoppable : 0;
    for (int i = first; i < first + object.user_particles; ++i) {
      if (!is_there(world_.state, at(i)) || object.bodies.has_centre(i - first)) continue;
      places.push_back(xyz(world_.state.positions[at(i)]));
      speed = std::max(speed, speed_of(i));
    }
    if (!places.empty() && speed > 0)
      add(BoxBounds::of(places.data(), static_cast<int>(places.size())), object.thickness, {number, speed});
  }

  void add_bodies(int number, const CompiledObject& object) {
    const int first = world_.model.first[at(number)], first_frame = world_.model.first_frame[at(number)];
    const bool moves = is_driven(number, object);
    std::vector<float> reach(object.bodies.bodies.size(), 0.f);
    for (const CompiledSolid& solid : object.bodies.solids)
      reach[at(solid.body)] = std::max(reach[at(solid.body)], static_cast<float>(length(solid.pose.position)) +
                                                                  bounding_radius(solid.shape) + object.thickness);
    for (std::size_t b = 0; b < reach.size(); ++b) {
      const CompiledBodies::Body& body = object.bodies.bodies[b];
      const float spin = length(xyz(world_.state.frames.angular_velocities[at(first_frame + body.frame)]));
      const bool slides =
          surface_velocity_of_body(world_.model, world_.workspace.control, number, static_cast<int>(b)) != Vec3f{};
      const float speed = moves || slides ? unstoppable : speed_of(first + body.particle) + reach[b] * spin;
      if (speed > 0) add(xyz(world_.state.positions[at(first + body.particle)]), reach[b], {number, speed});
    }
  }

  void add_collider(int number) {
    const Collider& collider = world_.model.colliders[at(number)];
    const PoseDrive* const drive = world_.workspace.control.collider(number);
    const bool is_set = drive != nullptr && drive->moves(),
               slides = surface_velocity_of_collider(world_.model, world_.workspace.control, number) != Vec3f{};
    if (!is_set && !slides && (drive != nullptr || !changes(collider.motion))) return;
    everywhere_ = everywhere_ || std::holds_alternative<Plane>(collider.shape);
    const auto* const box = std::get_if<Box>(&collider.shape);
    const auto* const sphere = std::get_if<Sphere>(&collider.shape);
    const auto* const capsule = std::get_if<Capsule>(&collider.shape);
    const float size = box != nullptr       ? length(box->half_extents)
                       : sphere != nullptr  ? sphere->radius
                       : capsule != nullptr ? capsule->radius + capsule->half_length
                                            : 0;
    const auto place_at = [&](double time) { return carried(pose_at(collider.motion, time), collider.position); };
    const std::array<Vec3f, 2> places =
        drive != nullptr
            ? std::array<Vec3f, 2>{convert<float>(drive->from.position), convert<float>(drive->to.position)}
            : std::array<Vec3f, 2>{place_at(world_.state.time), place_at(world_.state.time + dt_)};
    add(BoxBounds::of(places.data(), 2), size + collider.thickness, {-1, unstoppable});
  }

  const WorldData& world_;
  double dt_;
  float least_fast_ = std::numeric_limits<float>::infinity();
  bool everywhere_ = false;
  std::vector<BoxBounds> boxes_;
  std::vector<Mover> movers_;
  Tree<BoxBounds> tree_;
};

/// True if nothing may sleep in a step.
bool is_restless(const WorldData& world) { return !world.settings.sleep.on || !world.model.forces.empty(); }

/// Wakes the grains that sleep and touch another one of which `moves(other, number of its object)` is true.
template <class Moves>
void wake_beside(WorldData& world, const Rest& rest, const Moves& moves) {
  std::vector<int> woken;
  for (const GrainContact& contact : world.state.grain_contacts)
    for (const auto& [sleeper, other] : {std::pair{contact.a, contact.b}, std::pair{contact.b, contact.a}})
      if ((*rest.times)[at(sleeper)] == asleep && moves(other, world.model.object_of(other))) woken.push_back(sleeper);
  for (const int particle : woken) wake(world, rest, world.model.object_of(particle), particle);
}

/// Wakes grains that touch one that moves.
void wake_pushed(WorldData& world, const Rest& rest) {
  wake_beside(world, rest, [&](std::int32_t i, int number) {
    return (*rest.times)[at(i)] != asleep &&
           length(xyz(world.state.velocities[at(i)])) > wake_factor * slow_speed(world, number);
  });
}

/// Wakes grains that one has left, however slowly: it may have borne them.
void wake_left(WorldData& world, const Rest& rest, const std::vector<GrainContact>& touched) {
  const std::vector<GrainContact>& now = world.state.grain_contacts;
  for (const GrainContact& contact : touched) {
    if (std::binary_search(now.begin(), now.end(), contact, in_order_of_particles)) continue;
    for (const int particle : {contact.a, contact.b})
      if ((*rest.times)[at(particle)] == asleep) wake(world, rest, world.model.object_of(particle), particle);
  }
}

/// Wakes grains near which something moves fast, or has moved by a share of their radius since they fell asleep.
void wake_near_movers(WorldData& world, const Rest& rest, double dt) {
  const auto sleeps = [&](int i) { return (*rest.times)[at(i)] == asleep && is_there(world.state, at(i)); };
  const Movers movers(world, dt);
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    const CompiledObject& object = world.model.objects[at(number)];
    if (!object.grains) continue;
    if (world.workspace.control.object(number) != nullptr) {
      wake_grains(world, number);
      continue;
    }
    for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i) {
      if (!sleeps(i)) continue;
      float& shift = (*rest.shifts)[at(i)];
      shift += movers.speed_near(number, xyz(world.state.positions[at(i)])) * static_cast<float>(dt);
      if (shift > slow_share * object.grains->radius) wake(world, rest, number, i);
    }
  }
}

void fall_asleep(WorldData& world, const Rest& rest, int particle) {
  (*rest.times)[at(particle)] = asleep;
  (*rest.shifts)[at(particle)] = 0;
  world.state.positions[at(particle)].w = 0;
  world.state.velocities[at(particle)] = {};
}

}  // namespace

const float* grain_rest_times(const State& state) {
  for (const Channel& channel : state.channels)
    if (channel.name == rest_time_channel) return channel.values.data();
  return nullptr;
}

void wake_grains(WorldData& world, int number) {
  const Rest rest = rest_of(world.state);
  if (!rest || !world.model.objects[at(number)].grains) return;
  for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i)
    if ((*rest.times)[at(i)] == asleep) wake(world, rest, number, i);
}

void wake_all_grains(WorldData& world) {
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) wake_grains(world, number);
}

void wake_beside_gone(WorldData& world) {
  const Rest rest = rest_of(world.state);
  if (!rest) return;
  wake_beside(world, rest, [&](std::int32_t i, int) { return !is_there(world.state, at(i)); });
  for (std::size_t i = 0; i < rest.times->size(); ++i)
    if (!is_there(world.state, i)) (*rest.times)[i] = (*rest.shifts)[i] = 0;  // an emitter may put it elsewhere
}

Resting begin_rest(WorldData& world, double dt) {
  Resting resting;
  const Rest rest = rest_of(world.state);
  if (!rest || std::find(rest.times->begin(), rest.times->end(), asleep) == rest.times->end()) return resting;
  if (is_restless(world)) {
    wake_all_grains(world);
    return resting;
  }
  wake_near_movers(world, rest, dt);
  for (const GrainContact& contact : world.state.grain_contacts) {
    const bool a = (*rest.times)[at(contact.a)] == asleep, b = (*rest.times)[at(contact.b)] == asleep;
    if (a && b) resting.kept.push_back(contact);
    if (a != b) resting.touched.push_back(contact);
  }
  return resting;
}

int end_rest(WorldData& world, double elapsed, const Resting& resting) {
  if (is_restless(world) || !any_may_sleep(world.model)) return 0;
  std::vector<GrainContact>& contacts = world.state.grain_contacts;
  contacts.insert(contacts.end(), resting.kept.begin(), resting.kept.end());
  std::sort(contacts.begin(), contacts.end(), in_order_of_particles);
  make_channel(world.state, rest_time_channel);
  make_channel(world.state, rest_shift_channel);
  const Rest rest = rest_of(world.state);
  wake_pushed(world, rest);
  wake_left(world, rest, resting.touched);
  for_grains(world, [&](int number, int i) {
    float& time = (*rest.times)[at(i)];
    if (time == asleep || !(world.state.positions[at(i)].w > 0)) return;  // or an opening holds it
    const bool is_slow = length(xyz(world.state.velocities[at(i)])) < slow_speed(world, number);
    const bool was_slow = time > 0;  // at the top of a throw a grain is slow in one frame, not in two
    time = is_slow ? time + static_cast<float>(elapsed) : 0;
    if (is_slow && was_slow && time >= world.settings.sleep.time) fall_asleep(world, rest, i);
  });
  return static_cast<int>(std::count(rest.times->begin(), rest.times->end(), asleep));
}

}  // namespace pliant
