// What the user sets between steps, as spans over an object's particles in the user's order: motions, velocities, forces.
//
// Velocities and impulses change the State at once. Targets, poses and forces are for the next frame:
// Workspace::control keeps them until its end. Only poses of colliders without keyframes stay, in the State.
#include <algorithm>
#include <cmath>

#include "collision/fields/collider_pose.h"
#include "math/motion.h"
#include "pliant/error.h"
#include "world/implementation.h"

namespace pliant {

namespace {

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void refuse(const std::string& object, const std::string& element, const std::string& problem,
                         const std::string& advice) {
  throw Error({.object = object, .element = element}, problem, advice);
}

/// Throws an Error unless `values` has one finite vector for each particle of the object.
void require(const CompiledObject& object, std::span<const Vec3f> values, const char* what) {
  if (values.size() != static_cast<std::size_t>(object.user_particles)) {
    refuse(object.name, what,
           "are " + std::to_string(values.size()) + " for " + std::to_string(object.user_particles) + " particles",
           "give one per particle");
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_finite(values[i]))
      refuse(object.name, what + (" of particle " + std::to_string(i)), "is not finite", "give finite numbers");
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
  }
}

Vec3d place_of(const State& state, int particle) {
  const Record &x = state.positions[particle], &r = state.remainders[particle];
  return {double(x.x) + r.x, double(x.y) + r.y, double(x.z) + r.z};
}

/// Appends targets and sorts them by particle. If a particle has two targets, the later one is kept.
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

template <class Ids>
void require_poses(const Ids& ids, std::span<const RigidPose> poses, const char* kind) {
  if (ids.size() != poses.size()) {
    refuse("", kind + std::string("s"),
           "are " + std::to_string(ids.size()) + " for " + std::to_string(poses.size()) + " poses", "give one pose each");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Quatf& q = poses[i].rotation;
    const float size = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!is_finite(poses[i].position) || !(size > 1e-30f) || !std::isfinite(size))
      refuse("", kind + (" " + std::to_string(ids[i].slot)), "its pose is not finite, or its rotation is zero",
             "give finite numbers and a unit quaternion");
  }
}

Posed pose_of(const RigidPose& pose) { return {convert<double>(pose.position), normalise(convert<double>(pose.rotation))}; }
Posed pose_of(const HeldPose& pose) { return {convert<double>(pose.position), normalise(convert<double>(pose.rotation))}; }

void hold(std::vector<HeldPose>& poses, const HeldPose& pose) {
  const auto same = [&](const HeldPose& other) {
    return other.is_mesh == pose.is_mesh && other.slot == pose.slot && other.generation == pose.generation;
  };
  const auto at = std::find_if(poses.begin(), poses.end(), same);
  if (at == poses.end())
    poses.push_back(pose);
  else
    *at = pose;
}

}  // namespace

const HeldPose* World::Implementation::held(bool is_mesh, int slot) const {
  for (const HeldPose& pose : state.held_poses)
    if (pose.is_mesh == is_mesh && pose.slot == slot) return &pose;
  return nullptr;
}

Posed World::Implementation::pose_now(ColliderId id) const {
  const HeldPose* pose = held(false, id.slot);
  return pose != nullptr ? pose_of(*pose) : collider_pose(collider(id), state.time);
}

Posed World::Implementation::pose_now(MeshColliderId id) const {
  const HeldPose* pose = held(true, id.slot);
  return pose != nullptr ? pose_of(*pose) : pose_at(model.objects[mesh_collider_ids.number(id)].carrier.motion, state.time);
}

void World::Implementation::begin_control(double dt) {
  Control& control = workspace.control;
  for (auto* drives : {&control.colliders, &control.meshes}) {
    for (auto& [number, drive] : *drives) {
      drive.start = state.time;
      drive.end = state.time + dt;
    }
  }
  for (const HeldPose& pose : state.held_poses) {
    const Posed at = pose_of(pose);
    if (pose.is_mesh)
      control.meshes.emplace(mesh_collider_ids.number({pose.slot, pose.generation}), PoseDrive{at, at});
    else
      control.colliders.emplace(collider_ids.number({pose.slot, pose.generation}), PoseDrive{at, at});
  }
  if (may_drift) stop_fixed();
  may_drift = !control.objects.empty() || !control.meshes.empty();
}

/// Sets the velocity of fixed particles to zero if the user moved them in an earlier frame and does not move them in
/// this one.
void World::Implementation::stop_fixed() {
  for (int number = 0; number < static_cast<int>(model.objects.size()); ++number) {
    const CompiledObject& object = model.objects[number];
    if (object.carrier.moves() || workspace.control.mesh(number) != nullptr) continue;
    const ObjectControl* given = workspace.control.object(number);
    const auto moves = [&](int particle) {
      return lists(object.kinematics, particle) || (given != nullptr && lists(given->targets, particle));
    };
    for (int i = 0; i < object.particles; ++i) {
      const int at = model.first[number] + i;
      const Record& v = state.velocities[at];
      const bool drifts = state.positions[at].w == 0 && (v.x != 0 || v.y != 0 || v.z != 0);
      if (drifts && !moves(i)) state.velocities[at] = {};
    }
  }
}

void World::Implementation::end_control(bool was_stopped) {
  Control& control = workspace.control;
  const auto keep = [&](const PoseDrive& drive) {
    const Posed pose = was_stopped ? drive.at(state.time) : drive.to;
    return std::make_pair(convert<float>(pose.position), convert<float>(pose.rotation));
  };
  for (const auto& [number, drive] : control.colliders) {
    if (!drive.moves() || model.colliders[number].motion.moves()) continue;
    const ColliderId id = collider_ids.id_of(number);
    const auto [position, rotation] = keep(drive);
    hold(state.held_poses, {false, id.slot, id.generation, position, rotation});
  }
  for (const auto& [number, drive] : control.meshes) {
    if (!drive.moves() || model.objects[number].carrier.moves()) continue;
    const MeshColliderId id = mesh_collider_ids.id_of(number);
    const auto [position, rotation] = keep(drive);
    hold(state.held_poses, {true, id.slot, id.generation, position, rotation});
  }
  control = {};
}

void World::set_targets(ObjectId object, std::span<const int> particles, std::span<const Vec3f> positions) {
  const int number = self_->number(object), first = self_->model.first[number];
  const CompiledObject& of = self_->model.objects[number];
  const Listed listed{of, "particle", of.user_particles, 0};
  require(listed, particles, positions);
  for (const int particle : particles) {
    if (self_->state.positions[first + of.place[particle]].w > 0)
      refuse(of.name, "particle " + std::to_string(particle), "is dynamic, so it cannot have a target",
             "pin it first (World::edit), or use an attachment");
  }
  put_targets(listed, particles, positions, first, self_->state, self_->workspace.control.objects[number].targets);
}

void World::set_attachment_targets(ObjectId object, std::span<const int> attachments, std::span<const Vec3f> positions) {
  const int number = self_->number(object);
  const CompiledObject& of = self_->model.objects[number];
  const Listed listed{of, "attachment", of.particles - of.user_particles, of.user_particles};
  require(listed, attachments, positions);
  put_targets(listed, attachments, positions, self_->model.first[number], self_->state,
              self_->workspace.control.objects[number].targets);
}

void World::set_poses(std::span<const ColliderId> colliders, std::span<const RigidPose> poses) {
  for (const ColliderId id : colliders) (void)self_->collider(id);
  require_poses(colliders, poses, "collider");
  for (std::size_t i = 0; i < poses.size(); ++i)
    self_->workspace.control.colliders[self_->collider_ids.number(colliders[i])] = {self_->pose_now(colliders[i]),
                                                                                    pose_of(poses[i])};
}

void World::set_poses(std::span<const MeshColliderId> colliders, std::span<const RigidPose> poses) {
  for (const MeshColliderId id : colliders) (void)self_->mesh_collider_ids.number(id);
  require_poses(colliders, poses, "mesh collider");
  for (const MeshColliderId id : colliders) self_->workspace.control.objects.erase(self_->mesh_collider_ids.number(id));
  for (std::size_t i = 0; i < poses.size(); ++i)
    self_->workspace.control.meshes[self_->mesh_collider_ids.number(colliders[i])] = {self_->pose_now(colliders[i]),
                                                                                      pose_of(poses[i])};
}

void World::set_positions(MeshColliderId collider, std::span<const Vec3f> positions) {
  const int number = self_->mesh_collider_ids.number(collider);
  const CompiledObject& of = self_->model.objects[number];
  require(of, positions, "positions");
  if (of.groups == 0 && of.mask == 0)
    refuse(of.name, "", "is a distance grid or a heightfield, which cannot deform", "use it as triangles, or set its pose");
  self_->forget_pose(true, collider.slot);
  self_->workspace.control.meshes.erase(number);
  std::vector<int> all(positions.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  put_targets({of, "vertex", of.user_particles, 0}, all, positions, self_->model.first[number], self_->state,
              self_->workspace.control.objects[number].targets);
}

void World::set_velocities(ObjectId object, std::span<const Vec3f> velocities) {
  const int number = self_->number(object), first = self_->model.first[number];
  const CompiledObject& of = self_->model.objects[number];
  require(of, velocities, "velocities");
  for (int user = 0; user < of.user_particles; ++user) {
    const int i = first + of.place[user];
    const Vec3f& v = velocities[user];
    if (self_->state.positions[i].w > 0) self_->state.velocities[i] = {v.x, v.y, v.z, 0};
  }
}

void World::add_impulses(ObjectId object, std::span<const Vec3f> impulses) {
  const int number = self_->number(object), first = self_->model.first[number];
  const CompiledObject& of = self_->model.objects[number];
  require(of, impulses, "impulses");
  std::vector<Vec3f> velocities(impulses.size());
  for (int user = 0; user < of.user_particles; ++user) {
    const int i = first + of.place[user];
    const Record& v = self_->state.velocities[i];
    velocities[user] = Vec3f{v.x, v.y, v.z} + impulses[user] * self_->state.positions[i].w;
  }
  require(of, velocities, "velocities after the impulses");
  set_velocities(object, velocities);
}

void World::set_forces(ObjectId object, std::span<const Vec3f> forces) {
  const int number = self_->number(object);
  const CompiledObject& of = self_->model.objects[number];
  require(of, forces, "forces");
  std::vector<Vec3f>& in_storage = self_->workspace.control.objects[number].forces;
  in_storage.assign(of.particles, Vec3f{});
  for (int user = 0; user < of.user_particles; ++user) in_storage[of.place[user]] = forces[user];
}

}  // namespace pliant
