// Moves objects and colliders to other places between steps. Velocities turn with them and get nothing from the move.
//
// What lasts over frames and depends on places goes: contacts of bodies and grains in the State, and what contact
// between surfaces knows of the object, which is searched again as after an edit. So a World that goes on and one that
// restores its State have the same bits.
#include "world/teleport.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/at.h"
#include "inspect/problems.h"
#include "math/record.h"
#include "math/vector.h"
#include "pliant/error.h"
#include "world/control.h"
#include "world/groups.h"
#include "world/overlaps.h"
#include "world/resting_grains.h"

namespace pliant {

namespace {

[[noreturn]] void refuse_move(const std::string& name, const std::string& element, const std::string& problem,
                              const std::string& advice) {
  throw Error({.object = name, .element = element}, problem, advice);
}

/// The motion of a teleport. Throws an Error unless it is finite and its rotation is none of zero.
Posed motion_of(const std::string& name, const RigidPose& by) {
  const Quatf& q = by.rotation;
  const float size = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!is_finite(by.position) || !(size > 1e-30f) || !std::isfinite(size))
    refuse_move(name, "teleport", "its motion is not finite, or its rotation is zero",
                "give finite numbers and a unit quaternion");
  return {convert<double>(by.position), normalise(convert<double>(by.rotation))};
}

/// Throws an Error that names what holds an object back where it is.
void require_no_anchor(const CompiledObject& of) {
  const std::string advice =
      "remove the object and add it elsewhere, or change or remove that by an edit of the object first";
  if (!of.kinematics.empty()) {
    const int number = of.order[at(of.kinematics.front().particle)];
    const std::string element = number < of.user_particles ? "the pin of particle " + std::to_string(number)
                                                           : "attachment " + std::to_string(number - of.user_particles);
    refuse_move(of.name, element, "follows keyframes, which do not move with the object", advice);
  }
  if (!of.bodies.driven.empty())
    refuse_move(of.name, "the pin that turns a body", "follows keyframes, which do not move with the object", advice);
  for (std::size_t b = 0; b < of.bodies.labels.size(); ++b) {
    const auto is_of_body = [&](const CompiledSolid& solid) { return solid.body == static_cast<int>(b); };
    const bool is_solid = std::any_of(of.bodies.solids.begin(), of.bodies.solids.end(), is_of_body);
    if (of.bodies.labels[b].name == "world" && !is_solid && !of.joints.empty())
      refuse_move(of.name, "body 'world'", "holds it by joints and does not move with the object", advice);
  }
  if (!of.flow.emitters.empty())
    refuse_move(of.name, "emitter 0", "is fixed and does not move with the object", advice);
}

Vec3d precise_place(const State& state, int particle) {
  const Record &x = state.positions[at(particle)], &r = state.remainders[at(particle)];
  return {double(x.x) + double(r.x), double(x.y) + double(r.y), double(x.z) + double(r.z)};
}

/// Puts a particle at a place; its remainder is what floats round off.
void put_particle(const Vec3d& place, int particle, State& state) {
  Record& x = state.positions[at(particle)];
  x = {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z), x.w};
  state.remainders[at(particle)] = {static_cast<float>(place.x - double(x.x)),
                                    static_cast<float>(place.y - double(x.y)),
                                    static_cast<float>(place.z - double(x.z)), 0};
}

void turn_velocity(const Posed& motion, int particle, State& state) {
  Record& v = state.velocities[at(particle)];
  const Vec3f turned = convert<float>(rotate(motion.rotation, Vec3d{v.x, v.y, v.z}));
  v = {turned.x, turned.y, turned.z, 0};
}

/// Throws an Error if a particle of a block would be farther from the origin than scenes may have it.
void require_places(const WorldData& world, int number, const Posed& motion) {
  for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i)
    if (!is_place(convert<float>(to_world(motion, precise_place(world.state, i)))))
      refuse_move(world.model.objects[at(number)].name, "teleport", "it would be more than 1e9 m from the origin",
                  "give a smaller displacement, in metres");
}

void move_particles(WorldData& world, int number, const Posed& motion) {
  for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i) {
    put_particle(to_world(motion, precise_place(world.state, i)), i, world.state);
    turn_velocity(motion, i, world.state);
  }
}

void turn_frames(WorldData& world, int number, const Posed& motion) {
  Records& all = world.state.frames.orientations;
  for (int f = world.model.first_frame[at(number)]; f < world.model.end_of_frames(number); ++f) {
    const Record& q = all[at(f)];
    const Quatf turned = convert<float>(normalise(multiply(motion.rotation, Quatd{q.x, q.y, q.z, q.w})));
    all[at(f)] = {turned.x, turned.y, turned.z, turned.w};
  }
}

/// Forgets the contacts of bodies and grains with what was moved, and wakes all: what lay on it, or is touched now.
void forget_touched(WorldData& world, int owner) {
  State& state = world.state;
  std::erase_if(state.body_contacts,
                [&](const BodyContact& contact) { return contact.a.owner == owner || contact.b.owner == owner; });
  state.rest_times.clear();
  wake_all_grains(world);
  const auto is_of = [&](std::int32_t particle) { return world.model.object_of(particle) == owner; };
  std::erase_if(state.grain_contacts,
                [&](const GrainContact& contact) { return is_of(contact.a) || is_of(contact.b); });
  world.groups.bodies_meet_others = true;
  world.may_drift = true;
}

/// Targets that were set for the next step are reached from the new place.
void follow_targets(WorldData& world, int number) {
  const auto found = world.workspace.control.objects.find(number);
  if (found == world.workspace.control.objects.end()) return;
  for (Target& target : found->second.targets)
    target.from = precise_place(world.state, world.model.first[at(number)] + target.particle);
  for (TurnTarget& turn : found->second.turns) {
    const Record& q = world.state.frames.orientations[at(world.model.first_frame[at(number)] + turn.frame)];
    turn.from = normalise(convert<double>(Quatf{q.x, q.y, q.z, q.w}));
  }
}

HeldPose held_pose_of(bool is_mesh, int slot, int generation, const Posed& pose) {
  return {is_mesh, slot, generation, convert<float>(pose.position), convert<float>(pose.rotation)};
}

Posed as_posed(const HeldPose& held) {
  return {convert<double>(held.position), normalise(convert<double>(held.rotation))};
}

/// True if the vertices of a mesh collider are where its pose has them, and not where set_positions() left them.
bool is_posed(const WorldData& world, int number, const Posed& pose) {
  const Carrier& carrier = world.model.objects[at(number)].carrier;
  const CarrierPose places(carrier, world.state.time, pose);
  for (int i = 0; i < world.model.objects[at(number)].particles; ++i) {
    const Vec3d wanted = places.place(i), place = precise_place(world.state, world.model.first[at(number)] + i);
    if (length(place - wanted) > 1e-5 * (length(wanted) + 1e-3)) return false;
  }
  return true;
}

}  // namespace

void displace(WorldData& world, int number, const Posed& motion) {
  move_particles(world, number, motion);
  turn_frames(world, number, motion);
  follow_targets(world, number);
  forget_touched(world, number);
  note_surfaces(world, number);
}

void ObjectHandle::teleport(const RigidPose& by) {
  const int number = world_->number(id());
  const CompiledObject& of = world_->model.objects[at(number)];
  const Posed motion = motion_of(of.name, by);
  require_no_anchor(of);
  require_places(*world_, number, motion);
  displace(*world_, number, motion);
  if (of.fluid) mark_overlaps(*world_, number);
}

void ColliderHandle::teleport(const RigidPose& by) {
  const int number = world_->ids.colliders.number(id());
  const Collider& of = world_->model.colliders[at(number)];
  const Posed motion = motion_of(of.name, by);
  if (of.motion.moves())
    refuse_move(of.name, "teleport", "the collider follows keyframes, which do not move with it",
                "remove and add it elsewhere");
  const HeldPose held = held_pose_of(false, id().slot, id().generation, compose(motion, pose_now(*world_, id())));
  hold_pose(world_->state.held_poses, held);
  const auto drive = world_->workspace.control.colliders.find(number);
  if (drive != world_->workspace.control.colliders.end()) drive->second.from = as_posed(held);
  forget_touched(*world_, -1 - number);
}

void MeshColliderHandle::teleport(const RigidPose& by) {
  const int number = world_->ids.mesh_colliders.number(id());
  const CompiledObject& of = world_->model.objects[at(number)];
  const Posed motion = motion_of(of.name, by);
  if (of.carrier.moves())
    refuse_move(of.name, "teleport", "the collider follows keyframes, which do not move with it",
                "remove and add it elsewhere");
  require_places(*world_, number, motion);
  const Posed before = pose_now(*world_, id());
  const bool was_posed = is_posed(*world_, number, before);
  displace(*world_, number, motion);
  if (!was_posed) return;
  const HeldPose held = held_pose_of(true, id().slot, id().generation, compose(motion, before));
  hold_pose(world_->state.held_poses, held);
  const CarrierPose places(of.carrier, world_->state.time, as_posed(held));
  for (int i = 0; i < of.particles; ++i)
    put_particle(places.place(i), world_->model.first[at(number)] + i, world_->state);
  const auto drive = world_->workspace.control.meshes.find(number);
  if (drive != world_->workspace.control.meshes.end()) drive->second.from = as_posed(held);
  follow_targets(*world_, number);
}

}  // namespace pliant
