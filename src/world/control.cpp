// What the user sets between steps, as spans over an object's particles in the user's order: motions, velocities,
// forces.
//
// Velocities and impulses change the State at once. Targets, poses and forces are for the next frame:
// Workspace::control keeps them until its end. Only poses of colliders without keyframes stay, in the State.
#include "world/control.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/fields/collider_pose.h"
#include "constraints/joint_rows.h"
#include "core/at.h"
#include "inspect/problems.h"
#include "math/motion.h"
#include "math/vector.h"
#include "pliant/error.h"
#include "world/resting_grains.h"
#include "world/surface_velocities.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const std::string& object, const std::string& element, const std::string& problem,
                         const std::string& advice) {
  throw Error({.object = object, .element = element}, problem, advice);
}

/// Throws an Error unless `values` has one finite vector for each particle, or vertex of a mesh collider.
void require(const CompiledObject& object, std::span<const Vec3f> values, const char* what,
             const std::string& particle = "particle", const char* particles = "particles") {
  if (values.size() != static_cast<std::size_t>(object.user_particles)) {
    refuse(object.name, what,
           "are " + std::to_string(values.size()) + " for " + std::to_string(object.user_particles) + " " + particles,
           "give one per " + particle);
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_finite(values[i]))
      refuse(object.name, what + (" of " + particle + " " + std::to_string(i)), "is not finite", "give finite numbers");
}

/// Throws an Error if a place is so far from the origin that scenes may not have it: an uninitialised or wrong number.
void require_near(const Vec3f& place, const std::string& object, const std::string& element, const char* what) {
  if (!is_place(place))
    refuse(object, element, what + std::string(" is more than 1e9 m from the origin"), "give metres");
}

struct Listed {
  const CompiledObject& object;
  const char* kind;  ///< for messages: "particle" or "attachment"
  int count;         ///< number of such particles in the object
  int first;         ///< index in CompiledObject::place of the first one
};

void require(const Listed& of, std::span<const int> numbers, std::span<const Vec3f> places) {
  const std::string kind = of.kind;
  if (numbers.size() != places.size()) {
    refuse(of.object.name, kind + "s",
           "are " + std::to_string(numbers.size()) + " for " + std::to_string(places.size()) + " positions",
           "give one position per " + kind);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string element = kind + " " + std::to_string(numbers[i]);
    if (numbers[i] < 0 || numbers[i] >= of.count)
      refuse(of.object.name, element, "does not exist; there are " + std::to_string(of.count), "indices count from 0");
    if (!is_finite(places[i])) refuse(of.object.name, element, "its target is not finite", "give finite numbers");
    require_near(places[i], of.object.name, element, "its target");
  }
  std::vector<int> sorted(numbers.begin(), numbers.end());
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    refuse(of.object.name, kind + " " + std::to_string(*twice), "is given twice", "give each one position");
}

Vec3d place_of(const State& state, int particle) {
  const Record &x = state.positions[particle], &r = state.remainders[particle];
  return {double(x.x) + r.x, double(x.y) + r.y, double(x.z) + r.z};
}

/// Appends targets and sorts them by particle. Those of a later call replace those of an earlier one.
void put_targets(const Listed& of, std::span<const int> numbers, std::span<const Vec3f> places, int first,
                 const State& state, std::vector<Target>& targets) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int particle = of.object.place[of.first + numbers[i]];
    targets.push_back({particle, place_of(state, first + particle), convert<double>(places[i])});
  }
  std::stable_sort(targets.begin(), targets.end(),
                   [](const Target& a, const Target& b) { return a.particle < b.particle; });
  const auto last = std::unique(targets.rbegin(), targets.rend(),
                                [](const Target& a, const Target& b) { return a.particle == b.particle; });
  targets.erase(targets.begin(), last.base());
}

/// True if a list, sorted by particle, contains this particle.
template <class OfParticle>
bool lists(const std::vector<OfParticle>& list, int particle) {
  const auto at = std::lower_bound(list.begin(), list.end(), particle,
                                   [](const OfParticle& one, int other) { return one.particle < other; });
  return at != list.end() && at->particle == particle;
}

void require_pose(const RigidPose& pose, const std::string& object, const std::string& element) {
  const Quatf& q = pose.rotation;
  const float size = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!is_finite(pose.position) || !(size > 1e-30f) || !std::isfinite(size))
    refuse(object, element, "its pose is not finite, or its rotation is zero",
           "give finite numbers and a unit quaternion");
}

Posed pose_of(const RigidPose& pose) {
  return {convert<double>(pose.position), normalise(convert<double>(pose.rotation))};
}
Posed pose_of(const HeldPose& pose) {
  return {convert<double>(pose.position), normalise(convert<double>(pose.rotation))};
}

/// Inserts an element into a list that is ascending by `number`, or replaces the one with its number.
template <class T>
void put(const T& one, int T::*number, std::vector<T>& list) {
  const auto at =
      std::lower_bound(list.begin(), list.end(), one, [&](const T& a, const T& b) { return a.*number < b.*number; });
  if (at != list.end() && (*at).*number == one.*number)
    *at = one;
  else
    list.insert(at, one);
}

const HeldPose* held_pose(const WorldData& world, bool is_mesh, int slot) {
  for (const HeldPose& pose : world.state.held_poses)
    if (pose.is_mesh == is_mesh && pose.slot == slot) return &pose;
  return nullptr;
}

bool is_zero(const Record& r) { return r.x == 0 && r.y == 0 && r.z == 0; }

/// Sets the angular velocity of kinematic bodies to zero if nothing turns them in this frame.
void stop_turning(WorldData& world, int number) {
  const CompiledBodies& bodies = world.model.objects[number].bodies;
  const ObjectControl* given = world.workspace.control.object(number);
  std::size_t next = 0;  // of `driven`, in the order of bodies
  for (const CompiledBodies::Body& body : bodies.bodies) {
    const bool is_driven = next < bodies.driven.size() && bodies.driven[next].frame == body.frame;
    if (is_driven) ++next;
    const int at = world.model.first_frame[number] + body.frame;
    Record& spin = world.state.frames.angular_velocities[at];
    const bool drifts = is_zero(world.state.frames.inverse_inertias[at]) && !is_zero(spin);
    if (drifts && !is_driven && (given == nullptr || given->turn(body.frame) == nullptr)) spin = {};
  }
}

/// Sets the velocity of fixed particles and bodies to zero if the user moved them in an earlier frame and does not move
/// them in this one.
void stop_fixed(WorldData& world) {
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    const CompiledObject& object = world.model.objects[number];
    if (object.carrier.moves() || object.flow.is_used() || world.workspace.control.mesh(number) != nullptr) continue;
    const ObjectControl* given = world.workspace.control.object(number);
    const auto moves = [&](int particle) {
      return lists(object.kinematics, particle) || (given != nullptr && lists(given->targets, particle));
    };
    for (int i = 0; i < object.particles; ++i) {
      const int at = world.model.first[number] + i;
      const Record& v = world.state.velocities[at];
      const bool drifts = world.state.positions[at].w == 0 && (v.x != 0 || v.y != 0 || v.z != 0);
      if (drifts && !moves(i)) world.state.velocities[at] = {};
    }
    stop_turning(world, number);
  }
}

}  // namespace

void hold_pose(std::vector<HeldPose>& poses, const HeldPose& pose) {
  const auto same = [&](const HeldPose& other) {
    return other.is_mesh == pose.is_mesh && other.slot == pose.slot && other.generation == pose.generation;
  };
  const auto at = std::find_if(poses.begin(), poses.end(), same);
  if (at == poses.end())
    poses.push_back(pose);
  else
    *at = pose;
}

void wake_bodies(WorldData& world, int number) {
  wake_grains(world, number);
  std::vector<float>& times = world.state.rest_times;
  if (times.empty()) return;
  std::fill(times.begin() + world.model.first_frame[number], times.begin() + world.model.end_of_frames(number), 0.f);
}

Posed pose_now(const WorldData& world, ColliderId id) {
  const HeldPose* pose = held_pose(world, false, id.slot);
  return pose != nullptr ? pose_of(*pose) : collider_pose(world.collider(id), world.state.time);
}

Posed pose_now(const WorldData& world, MeshColliderId id) {
  const HeldPose* pose = held_pose(world, true, id.slot);
  return pose != nullptr
             ? pose_of(*pose)
             : pose_at(world.model.objects[world.ids.mesh_colliders.number(id)].carrier.motion, world.state.time);
}

void begin_control(WorldData& world, double dt) {
  Control& control = world.workspace.control;
  for (auto* drives : {&control.colliders, &control.meshes}) {
    for (auto& [number, drive] : *drives) {
      drive.start = world.state.time;
      drive.end = world.state.time + dt;
    }
  }
  for (const HeldPose& pose : world.state.held_poses) {
    const Posed at = pose_of(pose);
    if (pose.is_mesh)
      control.meshes.emplace(world.ids.mesh_colliders.number({pose.slot, pose.generation}), PoseDrive{at, at});
    else
      control.colliders.emplace(world.ids.colliders.number({pose.slot, pose.generation}), PoseDrive{at, at});
  }
  begin_surface_velocities(world);
  if (world.may_drift) stop_fixed(world);
  world.may_drift = !control.objects.empty() || !control.meshes.empty();
}

void end_control(WorldData& world, bool was_stopped) {
  Control& control = world.workspace.control;
  const auto keep = [&](const PoseDrive& drive) {
    const Posed pose = was_stopped ? drive.at(world.state.time) : drive.to;
    return std::make_pair(convert<float>(pose.position), convert<float>(pose.rotation));
  };
  for (const auto& [number, drive] : control.colliders) {
    if (!drive.moves() || world.model.colliders[number].motion.moves()) continue;
    const ColliderId id = world.ids.colliders.id_of(number);
    const auto [position, rotation] = keep(drive);
    hold_pose(world.state.held_poses, {false, id.slot, id.generation, position, rotation});
  }
  for (const auto& [number, drive] : control.meshes) {
    if (!drive.moves() || world.model.objects[number].carrier.moves()) continue;
    const MeshColliderId id = world.ids.mesh_colliders.id_of(number);
    const auto [position, rotation] = keep(drive);
    hold_pose(world.state.held_poses, {true, id.slot, id.generation, position, rotation});
  }
  control = {};
}

void forget_pose(WorldData& world, bool is_mesh, int slot) {
  std::erase_if(world.state.held_poses,
                [&](const HeldPose& pose) { return pose.is_mesh == is_mesh && pose.slot == slot; });
}

void ObjectHandle::set_targets(std::span<const int> particles, std::span<const Vec3f> positions) {
  const int number = world_->number(id()), first = world_->model.first[number];
  const CompiledObject& of = world_->model.objects[number];
  const Listed listed{of, "particle", of.user_particles, 0};
  require(listed, particles, positions);
  for (const int particle : particles) {
    if (of.positions[of.place[particle]].w > 0)
      refuse(of.name, "particle " + std::to_string(particle), "is dynamic, so it cannot have a target",
             "pin it in the description or by an edit of the object, or use an attachment");
  }
  wake_bodies(*world_, number);
  put_targets(listed, particles, positions, first, world_->state, world_->workspace.control.objects[number].targets);
}

void ObjectHandle::set_attachment_targets(std::span<const int> attachments, std::span<const Vec3f> positions) {
  const int number = world_->number(id());
  const CompiledObject& of = world_->model.objects[number];
  const Listed listed{of, "attachment", of.particles - of.user_particles, of.user_particles};
  require(listed, attachments, positions);
  wake_bodies(*world_, number);
  put_targets(listed, attachments, positions, world_->model.first[number], world_->state,
              world_->workspace.control.objects[number].targets);
}

void ObjectHandle::set_pose(int body, const RigidPose& pose) {
  const int number = world_->number(id()), first = world_->model.first[number];
  const CompiledObject& of = world_->model.objects[number];
  const CompiledBodies::Body& place = body_of(of, body);
  const auto index = static_cast<std::size_t>(body);
  const std::string& name = of.bodies.labels[index].name;
  const std::string element = "body " + std::to_string(body) + (name.empty() ? "" : " '" + name + "'");
  require_pose(pose, of.name, element);
  require_near(pose.position, of.name, element, "its pose");
  State& state = world_->state;
  const std::size_t frame = at(std::int64_t{world_->model.first_frame[number]} + place.frame);
  if (state.positions[first + place.particle].w > 0 || !is_zero(state.frames.inverse_inertias[frame]))
    refuse(of.name, element, "is dynamic, so its pose cannot be set",
           "make it kinematic, as by \"kinematic\": true in a scene");
  const Posed& described = of.bodies.labels[index].described;
  const Posed wanted = pose_of(pose);
  const Quatd axes = normalise(multiply(wanted.rotation, conjugate(described.rotation)));
  const Vec3d centre = wanted.position - rotate(axes, described.position);
  const Record& q = state.frames.orientations[frame];
  wake_bodies(*world_, number);
  ObjectControl& control = world_->workspace.control.objects[number];
  put({place.particle, place_of(state, first + place.particle), centre}, &Target::particle, control.targets);
  put({place.frame, normalise(convert<double>(Quatf{q.x, q.y, q.z, q.w})), axes}, &TurnTarget::frame, control.turns);
}

void ObjectHandle::set_pose(const std::string& body, const RigidPose& pose) {
  set_pose(body_of_name(world_->model.objects[static_cast<std::size_t>(world_->number(id()))], body), pose);
}

void ObjectHandle::set_velocities(std::span<const Vec3f> velocities) {
  const int number = world_->number(id()), first = world_->model.first[number];
  const CompiledObject& of = world_->model.objects[number];
  require(of, velocities, "velocities");
  wake_bodies(*world_, number);
  for (int user = 0; user < of.user_particles; ++user) {
    const int i = first + of.place[user];
    const Vec3f& v = velocities[user];
    if (world_->state.positions[i].w > 0) world_->state.velocities[i] = {v.x, v.y, v.z, 0};
  }
}

void ObjectHandle::add_impulses(std::span<const Vec3f> impulses) {
  const int number = world_->number(id()), first = world_->model.first[number];
  const CompiledObject& of = world_->model.objects[number];
  require(of, impulses, "impulses");
  wake_bodies(*world_, number);  // one that sleeps has no inverse mass
  std::vector<Vec3f> velocities(impulses.size());
  for (int user = 0; user < of.user_particles; ++user) {
    const int i = first + of.place[user];
    const Record& v = world_->state.velocities[i];
    velocities[user] = Vec3f{v.x, v.y, v.z} + impulses[user] * world_->state.positions[i].w;
  }
  require(of, velocities, "velocities after the impulses");
  set_velocities(velocities);
}

void ObjectHandle::set_forces(std::span<const Vec3f> forces) {
  const int number = world_->number(id());
  const CompiledObject& of = world_->model.objects[number];
  require(of, forces, "forces");
  wake_bodies(*world_, number);
  std::vector<Vec3f>& in_storage = world_->workspace.control.objects[number].forces;
  in_storage.assign(of.particles, Vec3f{});
  for (int user = 0; user < of.user_particles; ++user) in_storage[of.place[user]] = forces[user];
}

void ObjectHandle::set_pulls(std::span<const int> particles, std::span<const Vec3f> places,
                             std::span<const float> frequencies) {
  const int number = world_->number(id());
  const CompiledObject& of = world_->model.objects[number];
  require({of, "particle", of.user_particles, 0}, particles, places);
  if (frequencies.size() != particles.size())
    refuse(of.name, "frequencies",
           "are " + std::to_string(frequencies.size()) + " for " + std::to_string(particles.size()) + " particles",
           "give one per particle");
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    if (!(frequencies[i] >= 0 && std::isfinite(frequencies[i])))
      refuse(of.name, "particle " + std::to_string(particles[i]), "has a frequency that is negative or not finite",
             "give radians per second");
  wake_bodies(*world_, number);
  std::vector<Pull>& pulls = world_->workspace.control.objects[number].pulls;
  pulls.clear();
  pulls.reserve(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    pulls.push_back({of.place[particles[i]], places[i], frequencies[i]});
}

void ColliderHandle::set_pose(const RigidPose& pose) {
  const int number = world_->ids.colliders.number(id());
  require_pose(pose, "", "collider " + std::to_string(id().slot));
  world_->workspace.control.colliders[number] = {pose_now(*world_, id()), pose_of(pose)};
}

void MeshColliderHandle::set_pose(const RigidPose& pose) {
  const int number = world_->ids.mesh_colliders.number(id());
  require_pose(pose, "", "mesh collider " + std::to_string(id().slot));
  world_->workspace.control.objects.erase(number);
  world_->workspace.control.meshes[number] = {pose_now(*world_, id()), pose_of(pose)};
}

void MeshColliderHandle::set_positions(std::span<const Vec3f> positions) {
  const int number = world_->ids.mesh_colliders.number(id());
  const CompiledObject& of = world_->model.objects[number];
  require(of, positions, "positions", "vertex", "vertices");
  for (std::size_t i = 0; i < positions.size(); ++i)
    require_near(positions[i], of.name, "vertex " + std::to_string(i), "its target");
  if (of.groups == 0 && of.mask == 0)
    refuse(of.name, "", "is a distance grid or a heightfield, which cannot deform",
           "use it as triangles, or set its pose");
  forget_pose(*world_, true, id().slot);
  world_->workspace.control.meshes.erase(number);
  std::vector<int> all(positions.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  put_targets({of, "vertex", of.user_particles, 0}, all, positions, world_->model.first[number], world_->state,
              world_->workspace.control.objects[number].targets);
}

}  // namespace pliant
