// Gives objects their part of the State and the workspace when they are added, removed or edited, and takes it away.
#include "world/object_store.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "collision/fields/solid_fields.h"
#include "math/motion.h"
#include "matter/break_constraints.h"
#include "solver/bodies/joint_load.h"
#include "solver/fluids/fluid_overlaps.h"
#include "solver/sweeps/sweep.h"
#include "world/flow.h"
#include "world/groups.h"
#include "world/rest.h"
#include "world/resting_grains.h"
#include "world/soaking.h"
#include "world/surface_velocities.h"
#include "world/target_origins.h"

namespace pliant {

namespace {

/// Which multipliers to store: all if requested, else those that a second pass, residuals, or the limit of overstretch
/// need.
Multipliers kept_multipliers(const Settings& settings, Sweep sweep) {
  if (settings.record_multipliers || settings.record_residuals) return Multipliers::all;
  const bool more_passes = settings.iterations * sweep_method(sweep).passes > 1;
  if (more_passes || settings.measure) return Multipliers::needed;
  const bool is_limited = solves_chains(sweep) && settings.sweep_options.most_overstretch > 0;
  return is_limited ? Multipliers::lengths : Multipliers::lengths_in_last;
}

/// True if constraints of an object break by their force, which their multipliers tell.
bool breaks(const WorldData& world, int number) {
  if (world.descriptions.empty()) return false;
  const auto found = world.descriptions.find(world.ids.objects.id_of(number).slot);
  return found != world.descriptions.end() && can_break(found->second);
}

/// The part of the State that belongs to one object, in storage order.
struct ObjectState {
  Records positions, remainders, velocities, orientations, angular_velocities;
  std::vector<Channel> channels;  ///< those that the object owns
  std::vector<double> births;     ///< empty if State::births is
  std::vector<EmittedLayers> emitted;
  float substeps = 0;  ///< State::substeps
};

/// Resizes the State to the model's particles and frames.
void fit_state(WorldData& world) {
  const auto particles = static_cast<std::size_t>(world.model.particles());
  for (Records* records : {&world.state.positions, &world.state.remainders, &world.state.velocities})
    records->resize(particles);
  resize_frames(world.model, world.state.frames);
  if (!world.state.substeps.empty()) world.state.substeps.resize(world.model.objects.size());
  for (Channel& channel : world.state.channels)
    channel.values.resize(particles * static_cast<std::size_t>(channel.components));
  if (!world.state.births.empty()) world.state.births.resize(particles, 0.0);
}

/// True if a channel has values of an object's particles: of a gas or of tracers alone, or of every object.
bool owns(const CompiledObject& object, const Channel& channel) {
  if (channel.name == temperature_channel) return object.gas.has_value();
  if (channel.name == age_channel) return object.tracers.has_value();
  if (channel.name == water_channel) return object.absorbency.is_used;
  if (channel.name == overlap_channel) return false;                               // found again after an edit
  return channel.name != rest_time_channel && channel.name != rest_shift_channel;  // an edit wakes
}

/// Returns the State of an object, and sets that part of the State to zero.
ObjectState take_state(WorldData& world, int number) {
  const int first = world.model.first[number], particles = world.model.objects[number].particles;
  const int first_frame = world.model.first_frame[number], frames = world.model.end_of_frames(number) - first_frame;
  const auto slice = [](const auto& all, std::ptrdiff_t begin, std::ptrdiff_t count) {
    return std::decay_t<decltype(all)>(all.begin() + begin, all.begin() + begin + count);
  };
  ObjectState out{slice(world.state.positions, first, particles),
                  slice(world.state.remainders, first, particles),
                  slice(world.state.velocities, first, particles),
                  slice(world.state.frames.orientations, first_frame, frames),
                  slice(world.state.frames.angular_velocities, first_frame, frames),
                  {},
                  {},
                  {},
                  world.state.substeps.empty() ? 0 : world.state.substeps[static_cast<std::size_t>(number)]};
  for (Records* records :
       {&world.state.positions, &world.state.remainders, &world.state.velocities, &world.workspace.displacements})
    std::fill_n(records->begin() + first, particles, Record{});
  clear_frames(first_frame, frames, world.state.frames);
  for (Channel& channel : world.state.channels) {
    const std::ptrdiff_t begin = std::ptrdiff_t{first} * channel.components,
                         count = std::ptrdiff_t{particles} * channel.components;
    if (owns(world.model.objects[number], channel))
      out.channels.push_back({channel.name, channel.components, slice(channel.values, begin, count)});
    std::fill_n(channel.values.begin() + begin, count, 0.f);
  }
  if (!world.state.births.empty()) {
    out.births = slice(world.state.births, first, particles);
    std::fill_n(world.state.births.begin() + first, particles, 0.0);
  }
  for (const EmittedLayers& emitted : world.state.emitted)
    if (emitted.block == number) out.emitted.push_back(emitted);
  std::erase_if(world.state.emitted, [&](const EmittedLayers& emitted) { return emitted.block == number; });
  return out;
}

/// For each particle and frame of an object, the one of the object before it whose state it takes; -1: none. Particles
/// are in storage order.
struct Origins {
  std::vector<int> particles, frames;
};

/// The frame of a body follows the body's particle, others keep their index.
std::vector<int> frame_origins(const CompiledObject& old, const CompiledObject& by, const std::vector<int>& particles) {
  std::map<int, int> frame_of;  // [particle] of the bodies
  std::vector<char> is_of_body(old.frames.size());
  for (const CompiledBodies::Body& body : old.bodies.bodies) {
    frame_of[body.particle] = body.frame;
    is_of_body[static_cast<std::size_t>(body.frame)] = 1;
  }
  std::vector<int> from(by.frames.size(), -1);
  for (std::size_t i = 0; i < std::min(from.size(), is_of_body.size()); ++i)
    if (is_of_body[i] == 0) from[i] = static_cast<int>(i);
  for (const CompiledBodies::Body& body : by.bodies.bodies) {
    const auto found = frame_of.find(particles[static_cast<std::size_t>(body.particle)]);
    from[static_cast<std::size_t>(body.frame)] = found == frame_of.end() ? -1 : found->second;
  }
  return from;
}

bool any_comes_or_goes(const WorldData& world) {
  return std::any_of(world.model.objects.begin(), world.model.objects.end(),
                     [](const CompiledObject& object) { return object.flow.is_used(); });
}

void clear_births_if_nothing_flows(WorldData& world) {
  if (!any_comes_or_goes(world)) world.state.births.clear();
}

/// Of how many particles each old one is the origin.
std::vector<float> copies_of(const Origins& origins, std::size_t old_particles) {
  std::vector<float> copies(old_particles, 0.f);
  for (const int from : origins.particles)
    if (from >= 0) ++copies[static_cast<std::size_t>(from)];
  return copies;
}

/// Gives each particle and frame of an object the kept state of its origin.
void give_back_state(WorldData& world, int number, const ObjectState& kept, const Origins& origins) {
  const std::vector<float> copies = copies_of(origins, kept.positions.size());
  for (std::size_t i = 0; i < origins.particles.size(); ++i) {
    if (origins.particles[i] < 0) continue;
    const auto from = static_cast<std::size_t>(origins.particles[i]),
               at = static_cast<std::size_t>(world.model.first[number]) + i;
    Record& x = world.state.positions[at];
    x = {kept.positions[from].x, kept.positions[from].y, kept.positions[from].z, x.w};
    world.state.remainders[at] = kept.remainders[from];
    bool is_held = false;  // by the opening of an emitter
    if (!kept.births.empty() && !world.state.births.empty() && world.model.objects[number].flow.is_used()) {
      const double birth = world.state.births[at] = kept.births[from];
      is_held = birth > world.state.time && birth != not_there;
      x.w = birth > world.state.time ? 0 : world.model.objects[number].positions[i].w;
    }
    world.state.velocities[at] = x.w > 0 || is_held ? kept.velocities[from] : Record{};
    for (const Channel& channel : kept.channels) {
      if (!owns(world.model.objects[number], channel)) continue;
      const auto components = static_cast<std::size_t>(channel.components);
      const auto to = std::find_if(world.state.channels.begin(), world.state.channels.end(),
                                   [&](const Channel& one) { return one.name == channel.name; });
      const float share =
          channel.name == water_channel ? 1 / copies[from] : 1;  // a mass, which those that were one share
      for (std::size_t k = 0; k < components; ++k)
        to->values[at * components + k] = channel.values[from * components + k] * share;
    }
  }
  if (!world.state.substeps.empty()) world.state.substeps[static_cast<std::size_t>(number)] = kept.substeps;
  const auto first_frame = static_cast<std::size_t>(world.model.first_frame[number]);
  for (std::size_t i = 0; i < origins.frames.size(); ++i) {
    if (origins.frames[i] < 0) continue;
    const auto from = static_cast<std::size_t>(origins.frames[i]);
    world.state.frames.orientations[first_frame + i] = kept.orientations[from];
    const Record &spin = kept.angular_velocities[from], &inverse = world.state.frames.inverse_inertias[first_frame + i];
    world.state.frames.angular_velocities[first_frame + i] = {inverse.x > 0 ? spin.x : 0, inverse.y > 0 ? spin.y : 0,
                                                              inverse.z > 0 ? spin.z : 0, spin.w};
  }
}

/// Discards the contacts, broken joints, targets of motors and factors of rest data of an object's rigid bodies, and
/// the contacts of its grains.
void forget_contacts(WorldData& world, int number) {
  const StateBlock block = world.state.blocks[static_cast<std::size_t>(number)];
  const auto is_of_block = [&](int particle) {
    return particle >= block.first && particle < block.first + block.particles;
  };
  std::erase_if(world.state.grain_contacts,
                [&](const GrainContact& contact) { return is_of_block(contact.a) || is_of_block(contact.b); });
  std::erase_if(world.state.motors, [&](const MotorSetting& setting) { return setting.block == number; });
  forget_surface_velocities(world, SurfaceVelocity::Of::body, number);
  std::erase_if(world.state.rest_factors, [&](const RestFactor& factor) { return factor.block == number; });
  std::erase_if(world.state.broken_joints, [&](const BrokenJoint& joint) { return joint.block == number; });
  std::erase_if(world.state.body_contacts,
                [&](const BodyContact& contact) { return contact.a.owner == number || contact.b.owner == number; });
}

/// The names of an object's broken joints.
std::set<std::string> broken_joints_of(const WorldData& world, int number) {
  std::set<std::string> names;
  for (const BrokenJoint& joint : world.state.broken_joints)
    if (joint.block == number)
      names.insert(world.model.objects[number].joints[static_cast<std::size_t>(joint.joint)].name);
  return names;
}

/// Breaks the joints of these names again after an edit.
void break_again(WorldData& world, int number, const std::set<std::string>& names) {
  const std::vector<CompiledJoint>& joints = world.model.objects[number].joints;
  std::vector<int> broken;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (names.count(joints[j].name) != 0) broken.push_back(static_cast<int>(j));
  if (broken.empty()) return;
  for (const int joint : broken) world.state.broken_joints.push_back({number, joint});
  std::sort(world.state.broken_joints.begin(), world.state.broken_joints.end());
  set_broken(world.model.objects[number], broken, world.workspace.joints[number]);
}

/// Discards what the user set for an object or mesh collider that is removed or edited.
void forget_control(WorldData& world, int number) {
  world.workspace.control.objects.erase(number);
  world.workspace.control.meshes.erase(number);
}

/// Turns bodies whose pins turn to where they are at a time.
void turn_to_present(const CompiledObject& object, double time, Record* orientations) {
  for (const DrivenFrame& driven : object.bodies.driven) {
    const Quatf q = convert<float>(normalise(multiply(pose_at(driven.motion, time).rotation, driven.rest)));
    orientations[driven.frame] = {q.x, q.y, q.z, q.w};
  }
}

}  // namespace

void move_to_present(const CompiledObject& object, double time, Record* positions) {
  const auto put = [&](int particle, const Vec3d& place) {
    const Vec3f at = convert<float>(place);
    positions[particle] = {at.x, at.y, at.z, positions[particle].w};
  };
  if (object.carrier.moves()) {
    const CarrierPose pose(object.carrier, time);
    for (int i = 0; i < object.particles; ++i) put(i, pose.place(i));
  }
  for (const Kinematic& kinematic : object.kinematics)
    put(kinematic.particle, to_world(pose_at(kinematic.motion, time), convert<double>(kinematic.rest)));
}

std::shared_ptr<const SolidField> field_of(const MeshCollider& collider) {
  return collider.as == MeshCollider::As::triangles ? nullptr : solid_field_of(collider);
}

int add_to_model(WorldData& world, const MeshCollider& collider, CompiledObject compiled) {
  std::shared_ptr<const SolidField> field = field_of(collider);  // first, because it may throw
  const int number = world.model.add(std::move(compiled));
  add_field(world, collider, std::move(field), number);
  return number;
}

void add_field(WorldData& world, const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number) {
  if (field == nullptr) return;
  const auto after = std::find_if(world.model.fields.begin(), world.model.fields.end(),
                                  [&](const FieldCollider& one) { return one.object > number; });
  world.model.fields.insert(after,
                            {number, std::move(field), collider.motion, collider.thickness, collider.static_friction,
                             collider.kinetic_friction, collider.restitution, collider.groups, collider.mask});
}

void prepare_object(WorldData& world, int number) {
  world.state.rest_times.clear();  // what lay on the object, or may touch it now, wakes
  wake_all_grains(world);
  const Multipliers kept =
      breaks(world, number) ? Multipliers::all : kept_multipliers(world.settings, world.model.objects[number].sweep);
  pliant::prepare(world.model, number, kept, world.workspace);
  prepare_sweep(world.model, number, world.settings, world.executor.threads(), world.workspace);
  world.groups.objects_changed = true;
  world.groups.changed.push_back(number);
}

void place_object(WorldData& world, int number) {
  open_liquids(world);
  put_at_start(world.model, number, world.state);
  if (any_comes_or_goes(world)) world.state.births.resize(static_cast<std::size_t>(world.model.particles()), 0.0);
  if (number < static_cast<int>(world.state.substeps.size())) world.state.substeps[number] = 0;  // of an earlier object
  fit_state(world);
  if (world.state.time != 0) {
    const CompiledObject& object = world.model.objects[number];
    move_to_present(object, world.state.time, &world.state.positions[world.model.first[number]]);
    turn_to_present(object, world.state.time, world.state.frames.orientations.data() + world.model.first_frame[number]);
    follow_pressures(world, world.state.time);
  }
  follow_rest_factors(world, world.state.time);
  prepare_object(world, number);
  keep_flowed(world);
  note_surfaces(world, number);
}

void remove_object(WorldData& world, int number) {
  note_surfaces(world, number);
  forget_contacts(world, number);
  (void)take_state(world, number);
  world.model.remove(number);
  forget_control(world, number);
  std::erase_if(world.model.fields, [&](const FieldCollider& field) { return field.object == number; });
  world.state.blocks[number] = {0, 0, world.model.generation[number]};
  if (!world.state.substeps.empty()) world.state.substeps[number] = 0;
  clear_births_if_nothing_flows(world);
  const auto is_zero = [](float substeps) { return substeps == 0; };
  if (std::all_of(world.state.substeps.begin(), world.state.substeps.end(), is_zero)) world.state.substeps.clear();
  fit_state(world);
  prepare_object(world, number);
  keep_flowed(world);
  drop_unused_sweeps(world.model, world.workspace);
}

/// For each slot of an object's constraints, a particle or a frame after these, the one before it.
std::vector<int> slots_before(const Origins& origins, int particles_before) {
  std::vector<int> out = origins.particles;
  for (const int frame : origins.frames) out.push_back(frame < 0 ? -1 : particles_before + frame);
  return out;
}

void replace_object(WorldData& world, int number, CompiledObject by, const std::vector<int>& from) {
  note_surfaces(world, number);
  const CompiledObject& old = world.model.objects[number];
  const int particles = old.particles;
  const std::vector<int> targets = target_origins(old, by, from);
  const auto origin = [&](int user) {  // targets of attachments follow the particles in the user's order
    if (user < by.user_particles) return from[user] < 0 ? -1 : old.place[from[user]];
    const int target = targets[user - by.user_particles];
    return target < 0 ? -1 : old.place[old.user_particles + target];
  };
  Origins origins;
  for (const int user : by.order) origins.particles.push_back(origin(user));
  origins.frames = frame_origins(old, by, origins.particles);
  const std::set<std::string> broken = broken_joints_of(world, number);
  const ObjectState kept = take_state(world, number);
  const FlowedRest flowed = flowed_rest(old);
  forget_control(world, number);
  forget_contacts(world, number);
  if (old.flow.open && by.fluid && !by.gas) by.flow.open = true;  // what has soaked in elsewhere is not there
  world.model.replace(number, std::move(by));
  place_object(world, number);
  drop_unused_sweeps(world.model, world.workspace);
  give_back_state(world, number, kept, origins);
  if (world.model.objects[number].absorbency.is_used) set_wet_masses(world, number);
  break_again(world, number, broken);
  carry_flowed(flowed, slots_before(origins, particles), world.model.objects[number]);
  keep_flowed(world);
  clear_births_if_nothing_flows(world);
  const auto emitters = static_cast<std::int32_t>(world.model.objects[number].flow.emitters.size());
  for (const EmittedLayers& emitted : kept.emitted)
    if (emitted.emitter < emitters) world.state.emitted.push_back(emitted);
  std::sort(world.state.emitted.begin(), world.state.emitted.end(), in_order_of_emitters);
}

}  // namespace pliant
