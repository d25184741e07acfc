// Adds, removes and edits objects. Each object has a number in the model, a block in the State and its own part of the
// workspace, so the cost depends on that object alone. Contact between surfaces is updated once, before the next step.
#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "collision/fields/solid_fields.h"
#include "inspect/inspect_scene.h"
#include "math/motion.h"
#include "matter/advice_settings.h"
#include "model/object_sets.h"
#include "pliant/error.h"
#include "solver/sweeps/sweep.h"
#include "world/implementation.h"

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

constexpr int most_particles = std::numeric_limits<int>::max() / 4;

/// The sweep that objects too small for sweeps to differ follow; `automatic` if the object is such a one.
Sweep sweep_to_follow(const CompiledObject& object) {
  std::int64_t springs = 0;
  for (const LengthRange& range : object.lengths) springs += range.constraints;
  const auto particles = std::min(std::int64_t{object.particles}, springs + 1);
  return is_coarse(static_cast<std::size_t>(particles)) ? Sweep::automatic : object.sweep;
}

void require_room(const Model& model, std::size_t particles, const std::string& name) {
  if (particles > static_cast<std::size_t>(most_particles - model.particles()))
    throw Error({.object = name}, "its particles and those of the World are more than can be numbered",
                "make it smaller, or remove others first");
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

CompileOptions World::Implementation::compile_options(Sweep sweep) const {
  CompileOptions options;
  options.sweep = sweep;
  const int substeps =
      named_substeps() > 0 ? named_substeps() : substeps_of_others;  // own_substeps() of objects with PBD stiffness
  options.passes = substeps * settings.iterations * sweep_method(sweep).passes;
  options.chain_softness = settings.sweep_options.chain_softness;
  options.tethers = settings.sweep_options.tethers;
  options.tether_slack = settings.sweep_options.tether_slack;
  options.air = model.wind.air_density > 0;
  options.gravity = length(model.gravity);
  options.is_blown = blows(model.wind, model.forces);
  return options;
}

Sweep World::Implementation::sweep_of(const Object& object) const {
  if (object.sweep != Sweep::automatic) return object.sweep;
  if (!sweep_is_open) return settings.sweep;
  Scene scene;  // has of colliders and other objects only what decides whether the new one can meet them
  scene.settings.iterations = settings.iterations;
  scene.gravity = model.gravity;
  scene.colliders = model.colliders;
  const auto add_mesh = [&](MeshCollider::As as, const Masks& masks) {
    MeshCollider& mesh = scene.mesh_colliders.emplace_back();
    mesh.as = as;
    mesh.groups = masks.groups;
    mesh.mask = masks.mask;
  };
  for (const FieldCollider& field : model.fields) add_mesh(MeshCollider::As::distance_grid, {field.groups, field.mask});
  for (const CompiledObject& other : model.objects) {
    if (other.is_collider) {
      add_mesh(MeshCollider::As::triangles, {other.groups, other.mask});
    } else if (other.particles > 0) {
      Object& one = scene.objects.emplace_back();
      one.sweep = sweep_to_follow(other);
      one.collides = other.collides;
      one.groups = other.groups;
      one.mask = other.mask;
    }
  }
  scene.objects.push_back(object);
  return chosen_sweep(scene, static_cast<int>(scene.objects.size()) - 1);
}

void World::Implementation::require_accelerable(Sweep sweep, const std::string& name) const {
  if (sweep == Sweep::natural && settings.sweep_options.acceleration != SweepOptions::Acceleration::none)
    throw Error({.object = name, .element = "sweep"},
                "is natural, over which the Chebyshev acceleration of this World diverges",
                "give it the tiled, the symmetric or the Jacobi sweep");
}

int World::Implementation::add_to_model(const MeshCollider& collider, CompiledObject compiled) {
  std::shared_ptr<const SolidField> field = field_of(collider);  // first, because it may throw
  const int number = model.add(std::move(compiled));
  add_field(collider, std::move(field), number);
  return number;
}

void World::Implementation::add_field(const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number) {
  if (field == nullptr) return;
  const auto after =
      std::find_if(model.fields.begin(), model.fields.end(), [&](const FieldCollider& one) { return one.object > number; });
  model.fields.insert(after, {number, std::move(field), collider.motion, collider.thickness, collider.static_friction,
                              collider.kinetic_friction, collider.restitution, collider.groups, collider.mask});
}

void World::Implementation::put(int number) {
  put_at_start(model, number, state);
  if (number < static_cast<int>(state.substeps.size())) state.substeps[number] = 0;  // of an earlier object
  fit_state();
  if (state.time != 0) move_to_present(model.objects[number], state.time, &state.positions[model.first[number]]);
  prepare(number);
  note_surfaces(number);
}

void World::Implementation::remove(int number) {
  note_surfaces(number);
  (void)take(number);
  model.remove(number);
  forget_control(number);
  std::erase_if(model.fields, [&](const FieldCollider& field) { return field.object == number; });
  state.blocks[number] = {0, 0, model.generation[number]};
  if (!state.substeps.empty()) state.substeps[number] = 0;
  const auto is_zero = [](float substeps) { return substeps == 0; };
  if (std::all_of(state.substeps.begin(), state.substeps.end(), is_zero)) state.substeps.clear();
  fit_state();
  prepare(number);
  drop_unused_sweeps(model, workspace);
}

void World::Implementation::forget_control(int number) {
  workspace.control.objects.erase(number);
  workspace.control.meshes.erase(number);
}

void World::Implementation::prepare(int number) {
  pliant::prepare(model, number, kept_multipliers(settings, model.objects[number].sweep), workspace);
  prepare_sweep(model, number, settings, executor.threads(), workspace);
  objects_changed = true;
}

/// For each object that can collide by edges and triangles: prepares these, which depend on the colliders.
void World::Implementation::prepare_shape_contacts() {
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) workspace.shape_contacts.prepare(model, o);
}

void World::Implementation::note_surfaces(int number) {
  const CompiledObject& object = model.objects[number];
  const auto is_mesh = [](const CompiledObject& one) { return one.is_collider && one.groups != 0; };
  const auto has_pairs = [&](const SubstepGroup& group) { return pair_model != nullptr || group.pairs != nullptr; };
  if (std::any_of(groups.begin(), groups.end(), has_pairs) || object.self_collision ||
      (object.collides && object.groups != 0) || std::any_of(model.objects.begin(), model.objects.end(), is_mesh))
    changed_surfaces.push_back(number);
}

void World::Implementation::require_origins(int number, const Edit& edit) const {
  const CompiledObject& old = model.objects[number];
  const auto refuse = [&](const std::string& element, const std::string& problem) {
    throw Error({.object = edit.object.name, .element = element}, problem,
                "give for each new particle the index of the old particle that it replaces, or -1");
  };
  if (edit.from.size() != edit.object.positions.size())
    refuse("", "has " + std::to_string(edit.object.positions.size()) + " particles, but Edit::from has " +
                   std::to_string(edit.from.size()) + " entries");
  for (std::size_t i = 0; i < edit.from.size(); ++i)
    if (edit.from[i] < -1 || edit.from[i] >= old.user_particles)
      refuse("particle " + std::to_string(i),
             "replaces particle " + std::to_string(edit.from[i]) + ", which does not exist");
  require_room(model, edit.object.positions.size() + edit.object.attachments.size(), edit.object.name);
}

void World::Implementation::replace(int number, CompiledObject by, const std::vector<int>& from) {
  note_surfaces(number);
  const CompiledObject& old = model.objects[number];
  const int particles = old.particles;
  // Targets of attachments follow the particles in the user's order; an edit does not reorder them.
  const auto origin = [&](int user) {
    const int at = user < by.user_particles ? from[user] : user - by.user_particles + old.user_particles;
    return at < 0 || at >= particles ? -1 : old.place[at];
  };
  std::vector<int> origins;
  for (const int user : by.order) origins.push_back(origin(user));
  const ObjectState kept = take(number);
  forget_control(number);
  model.replace(number, std::move(by));
  put(number);
  drop_unused_sweeps(model, workspace);
  give_back(number, kept, origins);
}

ObjectState World::Implementation::take(int number) {
  const int first = model.first[number], particles = model.objects[number].particles;
  const int first_frame = model.first_frame[number], frames = model.end_of_frames(number) - first_frame;
  const auto slice = [](const auto& all, std::ptrdiff_t begin, std::ptrdiff_t count) {
    return std::decay_t<decltype(all)>(all.begin() + begin, all.begin() + begin + count);
  };
  ObjectState out{slice(state.positions, first, particles),
                  slice(state.remainders, first, particles),
                  slice(state.velocities, first, particles),
                  slice(state.frames.orientations, first_frame, frames),
                  slice(state.frames.angular_velocities, first_frame, frames),
                  {},
                  state.substeps.empty() ? 0 : state.substeps[static_cast<std::size_t>(number)]};
  for (Records* records : {&state.positions, &state.remainders, &state.velocities, &workspace.displacements})
    std::fill_n(records->begin() + first, particles, Record{});
  clear_frames(first_frame, frames, state.frames);
  for (Channel& channel : state.channels) {
    const std::ptrdiff_t begin = std::ptrdiff_t{first} * channel.components,
                         count = std::ptrdiff_t{particles} * channel.components;
    out.channels.push_back(slice(channel.values, begin, count));
    std::fill_n(channel.values.begin() + begin, count, 0.f);
  }
  return out;
}

void World::Implementation::give_back(int number, const ObjectState& kept, const std::vector<int>& origins) {
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (origins[i] < 0) continue;
    const auto from = static_cast<std::size_t>(origins[i]), at = static_cast<std::size_t>(model.first[number]) + i;
    Record& x = state.positions[at];
    x = {kept.positions[from].x, kept.positions[from].y, kept.positions[from].z, x.w};
    state.remainders[at] = kept.remainders[from];
    state.velocities[at] = x.w > 0 ? kept.velocities[from] : Record{};
    for (std::size_t c = 0; c < state.channels.size(); ++c) {
      const auto components = static_cast<std::size_t>(state.channels[c].components);
      for (std::size_t k = 0; k < components; ++k)
        state.channels[c].values[at * components + k] = kept.channels[c][from * components + k];
    }
  }
  if (!state.substeps.empty()) state.substeps[static_cast<std::size_t>(number)] = kept.substeps;
  const auto first_frame = static_cast<std::size_t>(model.first_frame[number]);
  const std::size_t frames = std::min(kept.orientations.size(), model.objects[number].frames.size());
  for (std::size_t i = 0; i < frames; ++i) {
    state.frames.orientations[first_frame + i] = kept.orientations[i];
    state.frames.angular_velocities[first_frame + i] = kept.angular_velocities[i];
  }
}

void World::Implementation::fit_state() {
  const auto particles = static_cast<std::size_t>(model.particles());
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->resize(particles);
  resize_frames(model, state.frames);
  if (!state.substeps.empty()) state.substeps.resize(model.objects.size());
  for (Channel& channel : state.channels) channel.values.resize(particles * static_cast<std::size_t>(channel.components));
}

void World::Implementation::forget_pose(bool is_mesh, int slot) {
  std::erase_if(state.held_poses, [&](const HeldPose& pose) { return pose.is_mesh == is_mesh && pose.slot == slot; });
}

void World::Implementation::make_pairs(SubstepGroup& group) {
  std::unique_ptr<PairModel>& pairs = group.has_all ? pair_model : group.pair_model;
  std::unique_ptr<SurfaceContact>& contact = group.has_all ? workspace.pairs : group.pairs;
  contact = nullptr;
  pairs = make_pair_model(model, group.has);  // `has` is empty if the group has all objects
  if (pairs == nullptr) return;
  pairs->filter = settings.contact_filter;
  if (settings.initial_intersections == Settings::Intersections::untangle)
    pairs->untangling_speed = settings.untangling_speed;
  contact = std::make_unique<SurfaceContact>(*pairs, kernels.pairs);
  workspace.look_for_tangles = true;
}

void World::Implementation::update_pairs(SubstepGroup& group, const std::vector<int>& changed) {
  PairModel* pairs = group.has_all ? pair_model.get() : group.pair_model.get();
  if (pairs == nullptr || pairs->untangling_speed > 0) return make_pairs(group);
  const std::optional<PairChanges> changes = update_pair_model(model, changed, *pairs);
  if (!changes) return make_pairs(group);
  (group.has_all ? workspace.pairs : group.pairs)->change(*changes);
}

void World::Implementation::take_over_pairs(SubstepGroup& group, SubstepGroup& before) {
  if (before.pair_model == nullptr) return make_pairs(group);
  std::vector<int> changed = changed_surfaces;
  for (int o = 0; o < static_cast<int>(group.has.size()); ++o) {
    const bool had = o < static_cast<int>(before.has.size()) && before.has[o] != 0;
    if (had != (group.has[o] != 0)) changed.push_back(o);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  group.pair_model = std::move(before.pair_model);
  group.pairs = std::move(before.pairs);
  group.pair_model->has = group.has;
  if (!changed.empty()) update_pairs(group, changed);
}

std::vector<SubstepGroup> World::Implementation::find_groups() const {
  std::vector<SubstepGroup> found;
  if (named_substeps() > 0)
    found.push_back(group_of_all(model, named_substeps()));
  else
    found = make_substep_groups(model);
  if (named_substeps() > 0 || (settings.tolerance <= 0 && !settings.record_residuals)) return found;
  int most = 0;  // because the tolerance is for all objects together
  for (const SubstepGroup& group : found) most = std::max(most, group.substeps);
  found.clear();
  found.push_back(group_of_all(model, most));
  return found;
}

namespace {

bool have_common_object(const SubstepGroup& a, const SubstepGroup& b) {
  const std::size_t count = std::min(a.has.size(), b.has.size());
  for (std::size_t o = 0; o < count; ++o)
    if (a.has[o] != 0 && b.has[o] != 0) return true;
  return false;
}

}  // namespace

void World::Implementation::prepare_groups() {
  std::vector<SubstepGroup> before = std::exchange(groups, find_groups());
  if (before.size() == 1 && groups.size() == 1) return;  // still one group of all objects, whose contact stays
  workspace.pairs = nullptr;
  pair_model = nullptr;
  for (SubstepGroup& group : groups) {
    const auto same = std::find_if(before.begin(), before.end(), [&](const SubstepGroup& one) {
      if (one.has_all || group.has_all || one.by_state != group.by_state) return false;
      return group.by_state ? have_common_object(one, group) : one.substeps == group.substeps;
    });
    same != before.end() ? take_over_pairs(group, *same) : make_pairs(group);
  }
  changed_surfaces.clear();
}

void World::Implementation::update_surfaces() {
  if (changed_surfaces.empty()) return;
  update_pairs(groups.front(), changed_surfaces);
  changed_surfaces.clear();
}

void World::Implementation::bring_up_to_date() {
  if (objects_changed || groups.empty()) prepare_groups();
  update_surfaces();
  if (!objects_changed) return;
  for (TileScratch& tile : workspace.tiles)
    tile.contacts.clear();  // contacts have collider indices, which may have changed
  if (settings.tolerance > 0) prepare_residual(model, workspace.residual);
  objects_changed = false;
}

// ---------------------------------------------------------------- World

ObjectId World::add(const Object& object) {
  refuse_grave(object);
  require_room(self_->model, object.positions.size() + object.attachments.size(), object.name);
  const Sweep sweep = self_->sweep_of(object);
  self_->require_accelerable(sweep, object.name);
  CompiledObject compiled = compile(object, self_->compile_options(sweep));
  self_->refuse_intersections(compiled, {object.groups, object.mask}, false);
  const int number = self_->model.add(std::move(compiled));
  self_->put(number);
  return self_->object_ids.add(number);
}

ColliderId World::add(const Collider& collider) {
  refuse_grave(collider);
  self_->model.colliders.push_back(collider);
  self_->prepare_shape_contacts();
  return self_->collider_ids.add(static_cast<int>(self_->model.colliders.size()) - 1);
}

MeshColliderId World::add(const MeshCollider& collider) {
  refuse_grave(collider);
  require_room(self_->model, collider.mesh.positions.size(), collider.name);
  CompiledObject compiled = compile(collider);
  const bool is_ground = collider.as == MeshCollider::As::heightfield;
  const Masks masks = is_ground ? Masks{0, 0} : Masks{collider.groups, collider.mask};
  self_->refuse_intersections(compiled, masks, collider.as == MeshCollider::As::distance_grid);
  const int number = self_->add_to_model(collider, std::move(compiled));
  self_->put(number);
  return self_->mesh_collider_ids.add(number);
}

std::vector<int> World::edit(ObjectId object, const Edit& edit) {
  const int number = self_->number(object);
  refuse_grave(edit.object);
  self_->require_origins(number, edit);
  const CompiledObject& old = self_->model.objects[number];
  std::vector<int> news(old.user_particles, -1);
  for (int i = static_cast<int>(edit.from.size()); i-- > 0;)
    if (edit.from[i] >= 0) news[edit.from[i]] = i;
  const Sweep sweep = edit.object.sweep == Sweep::automatic ? old.sweep : edit.object.sweep;
  self_->require_accelerable(sweep, edit.object.name);
  self_->overstretch.forget_object(object.slot);
  self_->replace(number, compile(edit.object, self_->compile_options(sweep)), edit.from);
  return news;
}

void World::remove(ObjectId object) {
  self_->remove(self_->number(object));
  self_->overstretch.forget_object(object.slot);
  self_->forget_touching(object);
  self_->object_ids.remove(object);
}

void World::remove(ColliderId collider) {
  const int number = self_->collider_ids.number(collider);
  self_->forget_pose(false, collider.slot);
  self_->forget_touching(collider);
  self_->collider_ids.remove(collider);
  self_->collider_ids.close_gap(number);
  self_->model.colliders.erase(self_->model.colliders.begin() + number);
  self_->prepare_shape_contacts();
  std::map<int, PoseDrive> drives;  // by new numbers: a removal decreases larger ones by one
  for (const auto& [other, drive] : self_->workspace.control.colliders)
    if (other != number) drives.emplace(other > number ? other - 1 : other, drive);
  self_->workspace.control.colliders = std::move(drives);
}

void World::remove(MeshColliderId collider) {
  self_->remove(self_->mesh_collider_ids.number(collider));
  self_->forget_pose(true, collider.slot);
  self_->forget_touching(collider);
  self_->mesh_collider_ids.remove(collider);
}

bool World::has(ObjectId object) const { return self_->object_ids.has(object); }
bool World::has(ColliderId collider) const { return self_->collider_ids.has(collider); }
bool World::has(MeshColliderId collider) const { return self_->mesh_collider_ids.has(collider); }

std::vector<ObjectId> World::objects() const { return self_->object_ids.all(); }
std::vector<ColliderId> World::colliders() const { return self_->collider_ids.all(); }
std::vector<MeshColliderId> World::mesh_colliders() const { return self_->mesh_collider_ids.all(); }

int World::object_count() const { return self_->object_ids.count(); }

}  // namespace pliant
