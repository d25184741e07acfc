// Restores a State, and computes its hash.
#include <algorithm>
#include <cmath>

#include "collision/bodies/body_contacts.h"
#include "core/sha256.h"
#include "pliant/error.h"
#include "solver/bodies/joint_load.h"
#include "solver/grains/grain_solver.h"
#include "world/control.h"
#include "world/flow.h"
#include "world/rest.h"
#include "world/resting_grains.h"
#include "world/soaking.h"
#include "world/surface_velocities.h"
#include "world/world_data.h"

namespace pliant {

namespace {

/// Upper limit of the frame number. It is far below the largest integer, so that counting on cannot overflow.
constexpr std::int64_t largest_frame = std::int64_t{1} << 60;

void add_records(Sha256& sha, const Records& records) { sha.add(records.data(), records.size() * sizeof(Record)); }

/// Throws an Error unless `given` has as many frames as the States of this World.
void require_frames_of(const FrameRecords& own, const FrameRecords& given) {
  const std::size_t frames = own.size();
  if (given.orientations.size() != frames || given.angular_velocities.size() != frames ||
      given.inverse_inertias.size() != frames)
    throw Error({}, "the state has " + std::to_string(given.size()) + " frames, the world " + std::to_string(frames),
                "restore a state of this world");
  for (std::size_t i = 0; i < frames; ++i) {
    const Record &q = given.orientations[i], &w = given.angular_velocities[i];
    const Record &inertia = given.inverse_inertias[i], &same = own.inverse_inertias[i];
    const std::string element = "frame " + std::to_string(i);
    if (inertia.x != same.x || inertia.y != same.y || inertia.z != same.z)
      throw Error({.element = element}, "its inertia is not this world's", "restore a state of this world");
    if (!std::isfinite(q.x + q.y + q.z + q.w) || !std::isfinite(w.x + w.y + w.z))
      throw Error({.element = element}, "its orientation or angular velocity is not finite",
                  "restore an earlier state");
  }
}

void require_channels(const State& state) {
  for (const Channel& channel : state.channels) {
    if (channel.components < 1 ||
        channel.values.size() / static_cast<std::size_t>(channel.components) != state.positions.size() ||
        channel.values.size() % static_cast<std::size_t>(channel.components) != 0)
      throw Error({.element = "channel '" + channel.name + "'"},
                  "has " + std::to_string(channel.values.size()) + " values of " + std::to_string(channel.components) +
                      " components for " + std::to_string(state.positions.size()) + " particles",
                  "give each particle as many values as the channel has components");
  }
}

void require_substeps(const State& state) {
  if (!state.substeps.empty() && state.substeps.size() != state.blocks.size())
    throw Error({},
                "the state has substeps of " + std::to_string(state.substeps.size()) + " objects, the world has " +
                    std::to_string(state.blocks.size()),
                "restore a state of this world");
  for (const float substeps : state.substeps)
    if (!(substeps >= 0 && substeps <= 10000))
      throw Error({}, "the state has an object of " + std::to_string(substeps) + " substeps", "give 0 to 10000");
}

/// A surface cannot hold less than no water.
void require_no_less_than_none(const CompiledObject& object, const State& state) {
  for (const Channel& channel : state.channels)
    if (channel.name == water_channel &&
        std::any_of(channel.values.begin(), channel.values.end(), [](float m) { return m < 0; }))
      throw Error({.object = object.name, .element = "channel 'water'"}, "has a negative mass",
                  "restore an earlier state");
}

/// What gases, tracers and wet surfaces read of the State must be there.
void require_channels_of(const Model& model, const State& state) {
  const auto require = [&](const CompiledObject& object, const char* name) {
    const auto found = std::find_if(state.channels.begin(), state.channels.end(), [&](const Channel& channel) {
      return channel.name == name && channel.components == 1;
    });
    if (found == state.channels.end())
      throw Error({.object = object.name, .element = std::string("channel '") + name + "'"}, "is missing in the state",
                  "restore a state of this world");
    if (std::any_of(found->values.begin(), found->values.end(), [](float value) { return !std::isfinite(value); }))
      throw Error({.object = object.name, .element = std::string("channel '") + name + "'"},
                  "has a value that is not finite", "restore an earlier state");
  };
  for (const CompiledObject& object : model.objects) {
    if (object.gas) require(object, temperature_channel);
    if (object.tracers) require(object, age_channel);
    if (object.absorbency.is_used) require(object, water_channel);
    if (object.absorbency.is_used) require_no_less_than_none(object, state);
  }
}

/// All numbers of a contact that must be finite.
bool is_finite(const BodyContact& c) {
  float sum = c.substep + c.twist_impulse;
  for (const Vec3f& v : {c.normal, c.tangent1, c.tangent2, c.arm_a, c.arm_b}) sum += v.x + v.y + v.z;
  for (std::size_t i = 0; i < 4; ++i) sum += c.x[i] + c.y[i] + c.gap[i] + c.impulse[i];
  for (const std::array<float, 2>& pair : {c.friction_impulse, c.rolling_impulse}) sum += pair[0] + pair[1];
  for (const std::array<Vec3f, 4>& list : {c.anchor_a, c.anchor_b})
    for (const Vec3f& v : list) sum += v.x + v.y + v.z;
  sum += c.position.x + c.position.y + c.position.z;
  for (const Quatf& q : {c.rotation, c.turned}) sum += (q.x + q.y) + (q.z + q.w);
  return std::isfinite(sum);
}

void require_body_contacts(const State& state) {
  const BodyContact* before = nullptr;
  for (const BodyContact& contact : state.body_contacts) {
    const std::string element = "contact " + std::to_string(&contact - state.body_contacts.data());
    const bool has_substep = contact.substep == 0 || contact.substep >= 1e-12f;
    if (contact.count < 1 || contact.count > 4 || !has_substep || !is_finite(contact))
      throw Error({.element = element}, "has a number of points outside 1 to 4, or a value that is not finite",
                  "restore a state of this world");
    if (before != nullptr && !in_order(*before, contact))
      throw Error({.element = element}, "is not in the order of its parts", "restore a state of this world");
    before = &contact;
  }
}

void require_grain_contacts(const Model& model, const State& state) {
  const auto is_grain = [&](int particle) {
    const int owner = model.object_of(particle);
    return owner >= 0 && model.objects[static_cast<std::size_t>(owner)].grains.has_value();
  };
  const GrainContact* before = nullptr;
  for (const GrainContact& contact : state.grain_contacts) {
    const bool exists = contact.a >= 0 && contact.a < contact.b &&
                        static_cast<std::size_t>(contact.b) < state.positions.size() && is_grain(contact.a) &&
                        is_grain(contact.b);
    const Vec3f& slip = contact.slip;
    const bool is_finite = std::isfinite(slip.x) && std::isfinite(slip.y) && std::isfinite(slip.z);
    if (!exists || !is_finite || (before != nullptr && !in_order_of_particles(*before, contact)))
      throw Error({.element = "grain contact " + std::to_string(&contact - state.grain_contacts.data())},
                  "names no two grains, is not in ascending order, or has a number that is not finite",
                  "restore a state of this world, or clear its grain_contacts");
    before = &contact;
  }
}

/// The times and shifts of grains that sleep, or may.
void require_grains_at_rest(const State& state) {
  for (const Channel& channel : state.channels) {
    if (channel.name != rest_time_channel && channel.name != rest_shift_channel) continue;
    const bool is_right =
        channel.components == 1 && std::all_of(channel.values.begin(), channel.values.end(), [](float value) {
          return std::isfinite(value) && (value >= 0 || value == asleep);
        });
    if (!is_right)
      throw Error({.element = "channel '" + channel.name + "'"},
                  "has more than one component, or a value that is negative or not finite", "restore an earlier state");
  }
  const float* const times = grain_rest_times(state);
  for (std::size_t i = 0; times != nullptr && i < state.births.size(); ++i)
    if (times[i] == asleep && state.births[i] == not_there)
      throw Error({.element = "particle " + std::to_string(i)}, "sleeps but is not there", "restore an earlier state");
}

void require_broken_joints(const Model& model, const State& state) {
  const BrokenJoint* before = nullptr;
  for (const BrokenJoint& broken : state.broken_joints) {
    const bool is_known = broken.block >= 0 && static_cast<std::size_t>(broken.block) < model.objects.size() &&
                          broken.joint >= 0 &&
                          static_cast<std::size_t>(broken.joint) < model.objects[broken.block].joints.size();
    if (!is_known || (before != nullptr && !(*before < broken)))
      throw Error({.element = "broken joint " + std::to_string(&broken - state.broken_joints.data())},
                  "does not exist or is not in ascending order", "restore a state of this world");
    before = &broken;
  }
}

/// Leaves out the joints that are broken in the State.
void break_joints_of_state(WorldData& world) {
  for (std::size_t o = 0; o < world.model.objects.size(); ++o) {
    std::vector<int> broken;
    for (const BrokenJoint& joint : world.state.broken_joints)
      if (joint.block == static_cast<int>(o)) broken.push_back(joint.joint);
    if (broken == world.workspace.joints[o].broken) continue;
    set_broken(world.model.objects[o], broken, world.workspace.joints[o]);
    world.groups.bodies_meet_others = true;
  }
}

const CompiledJoint::Motor* find_motor(const Model& model, const MotorSetting& setting) {
  const auto at = [](const auto& list, int index) {
    return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                       : nullptr;
  };
  const CompiledObject* object = at(model.objects, setting.block);
  const CompiledJoint* joint = object == nullptr ? nullptr : at(object->joints, setting.joint);
  return joint == nullptr ? nullptr : at(joint->motors, setting.motor);
}

void require_motors(const Model& model, const State& state) {
  const MotorSetting* before = nullptr;
  for (const MotorSetting& setting : state.motors) {
    const bool is_known = find_motor(model, setting) != nullptr && std::isfinite(setting.target) && setting.most > 0;
    if (!is_known || (before != nullptr && !is_earlier(*before, setting)))
      throw Error({.element = "motor " + std::to_string(&setting - state.motors.data())},
                  "does not exist, is not in ascending order, or has a number that is not finite",
                  "restore a state of this world");
    before = &setting;
  }
}

/// Gives all motors the targets of the State, or those of their description.
void set_motors_of_state(WorldData& world) {
  for (CompiledObject& object : world.model.objects)
    for (const CompiledJoint& joint : object.joints)
      for (const CompiledJoint::Motor& motor : joint.motors) set_motor(object, joint, motor, motor.target, motor.most);
  for (const MotorSetting& setting : world.state.motors) {
    CompiledObject& object = world.model.objects[static_cast<std::size_t>(setting.block)];
    const CompiledJoint& joint = object.joints[static_cast<std::size_t>(setting.joint)];
    set_motor(object, joint, joint.motors[static_cast<std::size_t>(setting.motor)], setting.target, setting.most);
  }
}

/// True if blocks are contiguous and in order, as in a World in which nothing was removed or edited.
bool follow_one_another(const std::vector<StateBlock>& blocks) {
  int first = 0;
  for (const StateBlock& block : blocks) {
    if (block.first != first || block.generation != 0) return false;
    first += block.particles;
  }
  return true;
}

void require_held_poses(const WorldData& world, const State& given) {
  for (const HeldPose& pose : given.held_poses) {
    const bool exists = pose.is_mesh ? world.ids.mesh_colliders.has({pose.slot, pose.generation})
                                     : world.ids.colliders.has({pose.slot, pose.generation});
    if (!exists)
      throw Error({}, "the state holds a pose of a collider that this World does not have",
                  "restore a state of this world");
    const Quatf& q = pose.rotation;
    const Vec3f& x = pose.position;
    bool is_finite = true;
    for (const float value : {x.x, x.y, x.z, q.x, q.y, q.z, q.w}) is_finite = is_finite && std::isfinite(value);
    if (!is_finite) throw Error({}, "the state holds a pose that is not finite", "restore an earlier state");
  }
}

void require_rest_times(const State& state) {
  if (!state.rest_times.empty() && state.rest_times.size() != state.frames.size())
    throw Error({},
                "the state has times of rest of " + std::to_string(state.rest_times.size()) +
                    " frames, of which it has " + std::to_string(state.frames.size()),
                "restore a state of this world, or clear its rest_times, which wakes all bodies");
  for (std::size_t i = 0; i < state.rest_times.size(); ++i)
    if (!(state.rest_times[i] >= 0 || state.rest_times[i] == asleep) || std::isinf(state.rest_times[i]))
      throw Error({.element = "frame " + std::to_string(i)},
                  "its time of rest is " + std::to_string(state.rest_times[i]) + " s",
                  "give 0 or more, or -1 for a body that sleeps");
}

/// Throws an Error if the blocks of particles of a State differ from those of this World.
void require_blocks(const WorldData& world, const State& given) {
  const std::vector<StateBlock>& own = world.state.blocks;
  if (given.blocks == own) return;
  const auto other = std::mismatch(given.blocks.begin(), given.blocks.end(), own.begin(), own.end()).second;
  const std::string name =
      other != own.end() ? world.model.objects[static_cast<std::size_t>(other - own.begin())].name : "";
  throw Error({.object = name},
              "the state is of a World with other objects, or from before one was added, removed or edited",
              "restore a state that was taken since the last such change");
}

/// What a particle of a surface with Absorbency holds [kg].
float water_at(const State& state, std::size_t particle) {
  for (const Channel& channel : state.channels)
    if (channel.name == water_channel) return channel.values[particle];
  return 0;
}

bool sleeps_in(const State& state, std::size_t particle) {
  const float* const times = grain_rest_times(state);
  return times != nullptr && times[particle] == asleep;
}

/// True if a particle of a State may have this inverse mass: none if it is not there, or has just left an opening.
bool may_have_mass(const WorldData& world, const State& state, std::size_t particle, float inverse_mass) {
  const float now = world.state.positions[particle].w;
  if (state.births.empty() && state.channels.empty() && world.state.channels.empty()) return inverse_mass == now;
  const int owner = world.model.object_of(static_cast<int>(particle));
  if (owner < 0) return inverse_mass == now;  // of no object
  const auto number = static_cast<std::size_t>(owner);
  const CompiledObject& object = world.model.objects[number];
  const std::size_t index = particle - static_cast<std::size_t>(world.model.first[number]);
  if (index >= object.positions.size()) return inverse_mass == now;  // of no object
  const float compiled = object.positions[index].w;
  if (object.absorbency.is_used)
    return inverse_mass == (now > 0 ? wet_inverse_mass(compiled, water_at(state, particle)) : 0);
  if (object.grains && sleeps_in(state, particle)) return inverse_mass == 0 && compiled > 0;
  if (state.births.empty() || !object.flow.is_used()) return inverse_mass == (object.grains ? compiled : now);
  if (state.births[particle] == not_there) return inverse_mass == 0;
  return inverse_mass == 0 || inverse_mass == compiled;
}

void require_births(const WorldData& world, const State& state) {
  if (state.births.size() != world.state.births.size())
    throw Error({},
                "the state has times of birth of " + std::to_string(state.births.size()) + " particles, the world of " +
                    std::to_string(world.state.births.size()),
                "restore a state of this world");
  for (std::size_t i = 0; i < state.births.size(); ++i)
    if (!std::isfinite(state.births[i]))
      throw Error({.element = "particle " + std::to_string(i)}, "its time of birth is not finite",
                  "restore an earlier state");
  const EmittedLayers* before = nullptr;
  for (const EmittedLayers& emitted : state.emitted) {
    const bool is_known = emitted.block >= 0 && static_cast<std::size_t>(emitted.block) < world.model.objects.size() &&
                          emitted.emitter >= 0 && emitted.layers >= 0 &&
                          static_cast<std::size_t>(emitted.emitter) <
                              world.model.objects[static_cast<std::size_t>(emitted.block)].flow.emitters.size();
    if (!is_known || (before != nullptr && !in_order_of_emitters(*before, emitted)))
      throw Error({.element = "emitted layers " + std::to_string(&emitted - state.emitted.data())},
                  "are of no emitter, or not in ascending order", "restore a state of this world");
    before = &emitted;
  }
}

}  // namespace

void World::restore(const State& state) {
  require_blocks(*data_, state);
  require_held_poses(*data_, state);
  require_surface_velocities(*data_, state);
  const std::size_t particles = data_->state.positions.size();
  if (state.positions.size() != particles || state.velocities.size() != particles ||
      state.remainders.size() != particles) {
    throw Error({},
                "the state has " + std::to_string(state.positions.size()) + " particles, the world " +
                    std::to_string(particles),
                "restore a state of this world");
  }
  if (!state.births.empty() && data_->state.births.empty()) open_all_liquids(*data_);
  require_births(*data_, state);
  require_channels(state);
  require_grains_at_rest(state);
  require_channels_of(data_->model, state);
  const auto is_finite = [](const Record& r) { return std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z); };
  for (std::size_t i = 0; i < particles; ++i) {
    if (!may_have_mass(*data_, state, i, state.positions[i].w)) {
      throw Error({.element = "particle " + std::to_string(i)}, "its mass is not this world's",
                  "restore a state of this world");
    }
    if (state.velocities[i].w != 0 || state.remainders[i].w != 0) {
      throw Error({.element = "particle " + std::to_string(i)},
                  "the fourth number of its velocity or remainder is not 0", "restore a state of this world");
    }
    if (!is_finite(state.positions[i]) || !is_finite(state.velocities[i]) || !is_finite(state.remainders[i])) {
      throw Error({.element = "particle " + std::to_string(i)}, "its position or velocity is not finite",
                  "restore an earlier state");
    }
  }
  require_frames_of(data_->state.frames, state.frames);
  require_substeps(state);
  require_body_contacts(state);
  require_grain_contacts(data_->model, state);
  require_broken_joints(data_->model, state);
  require_motors(data_->model, state);
  require_rest_times(state);
  require_rest(data_->model, state);
  if (!std::isfinite(state.time)) throw Error({}, "the state's time is not finite", "restore an earlier state");
  if (state.frame < 0 || state.frame > largest_frame)
    throw Error({}, "the state's frame is " + std::to_string(state.frame), "restore a state of this world");
  data_->state = state;
  break_joints_of_state(*data_);
  set_motors_of_state(*data_);
  follow_pressures(*data_, state.time);
  take_rest_of_state(*data_);
  forget_multipliers(*data_, false);
  data_->workspace.look_for_tangles = true;
  data_->stopped = false;
  data_->may_drift = true;
  data_->overstretch.restart();
  data_->convergence.restart();
  data_->workspace.control = {};
  data_->workspace.joint_loads.clear();
  data_->events.touching.clear();
  data_->events.of_last_step.clear();
  data_->events.touches.clear();
}

std::string hash(const State& state) {
  Sha256 sha;
  sha.add(&state.time, sizeof state.time);
  sha.add(&state.frame, sizeof state.frame);
  if (!follow_one_another(state.blocks)) sha.add(state.blocks.data(), state.blocks.size() * sizeof(StateBlock));
  add_records(sha, state.positions);
  add_records(sha, state.remainders);
  add_records(sha, state.velocities);
  if (state.frames.size() > 0) {
    add_records(sha, state.frames.orientations);
    add_records(sha, state.frames.angular_velocities);
    add_records(sha, state.frames.inverse_inertias);
  }
  for (const Channel& channel : state.channels) {
    const std::uint64_t sizes[] = {channel.name.size(), static_cast<std::uint64_t>(channel.components),
                                   channel.values.size()};
    sha.add(sizes, sizeof sizes);
    sha.add(channel.name.data(), channel.name.size());
    sha.add(channel.values.data(), channel.values.size() * sizeof(float));
  }
  for (const HeldPose& pose : state.held_poses) {
    const int thing[] = {pose.is_mesh ? 1 : 0, pose.slot, pose.generation};
    sha.add(thing, sizeof thing);
    sha.add(&pose.position, sizeof pose.position);
    sha.add(&pose.rotation, sizeof pose.rotation);
  }
  if (!state.substeps.empty()) sha.add(state.substeps.data(), state.substeps.size() * sizeof(float));
  if (!state.broken_joints.empty())
    sha.add(state.broken_joints.data(), state.broken_joints.size() * sizeof(BrokenJoint));
  if (!state.motors.empty()) sha.add(state.motors.data(), state.motors.size() * sizeof(MotorSetting));
  if (!state.body_contacts.empty())
    sha.add(state.body_contacts.data(), state.body_contacts.size() * sizeof(BodyContact));
  if (!state.rest_times.empty()) sha.add(state.rest_times.data(), state.rest_times.size() * sizeof(float));
  if (!state.grain_contacts.empty())
    sha.add(state.grain_contacts.data(), state.grain_contacts.size() * sizeof(GrainContact));
  if (!state.births.empty()) sha.add(state.births.data(), state.births.size() * sizeof(double));
  if (!state.emitted.empty()) sha.add(state.emitted.data(), state.emitted.size() * sizeof(EmittedLayers));
  if (!state.rest_factors.empty()) sha.add(state.rest_factors.data(), state.rest_factors.size() * sizeof(RestFactor));
  if (!state.flowed.empty()) sha.add(state.flowed.data(), state.flowed.size() * sizeof(float));
  if (!state.surface_velocities.empty())
    sha.add(state.surface_velocities.data(), state.surface_velocities.size() * sizeof(SurfaceVelocity));
  return sha.finish();
}

}  // namespace pliant
