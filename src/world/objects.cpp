// Adds, removes and edits what is in a World, and lists it.
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "inspect/inspect_scene.h"
#include "matter/advice_settings.h"
#include "matter/surroundings.h"
#include "model/keep_schedule.h"
#include "model/object_sets.h"
#include "pliant/error.h"
#include "solver/sweeps/sweep.h"
#include "world/control.h"
#include "world/events.h"
#include "world/intersections.h"
#include "world/object_store.h"
#include "world/objects.h"
#include "world/overlaps.h"
#include "world/resting_grains.h"
#include "world/surface_velocities.h"
#include "world/tearing.h"
#include "world/touching_starts.h"

namespace pliant {

namespace {

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

/// What an object that is added now has around it: it is the last object.
Surroundings surroundings_of(const WorldData& world, const Object& added) {
  Surroundings found;
  std::vector<SubstepRule> rules;
  for (const CompiledObject& other : world.model.objects) {
    if (other.is_collider || other.particles == 0) continue;
    found.members.push_back({other.groups, other.mask, other.collides});
    rules.push_back(other.substep_rule);
  }
  found.gravity = magnitude(world.model.gravity);
  found.frame_time = static_cast<double>(world.frame_time);
  found.members.push_back(member_of(added, 0, SubstepRule::any));
  rules.push_back(substep_rule(added, Sweep::chains, found.gravity));
  found.rule_of = [rules](std::size_t number) { return rules[number]; };
  for (const CompiledObject& other : world.model.objects)
    if (other.is_collider) found.members.push_back({other.groups, other.mask, false, true});
  for (const FieldCollider& field : world.model.fields) found.other_meshes.push_back({field.groups, field.mask});
  found.has_primitives = !world.model.colliders.empty();
  return found;
}

/// The sweep that an object gets if it is added now.
Sweep sweep_for(const WorldData& world, const Object& object) {
  if (object.sweep != Sweep::automatic) return object.sweep;
  if (!world.open.sweep) return world.settings.sweep;
  Settings settings = world.settings;
  settings.sweep = Sweep::automatic;
  settings.substeps = named_substeps(world);
  std::vector<Sweep> others;
  for (const CompiledObject& other : world.model.objects)
    if (!other.is_collider && other.particles > 0) others.push_back(sweep_to_follow(other));
  return chosen_sweep(object, surroundings_of(world, object), settings, others);
}

/// Throws an Error if the acceleration in the settings does not support the sweep.
void require_accelerable(const WorldData& world, Sweep sweep, const std::string& name) {
  if (sweep == Sweep::natural && world.settings.sweep_options.acceleration != SweepOptions::Acceleration::none)
    throw Error({.object = name, .element = "sweep"},
                "is natural, over which the Chebyshev acceleration of this World diverges",
                "give it the tiled, the symmetric or the Jacobi sweep");
}

/// Throws an Error if an edit names origins of particles that do not exist.
void require_origins(const WorldData& world, int number, const Edit& edit) {
  const CompiledObject& old = world.model.objects[number];
  const auto refuse = [&](const std::string& element, const std::string& problem) {
    throw Error({.object = edit.object.name, .element = element}, problem,
                "give for each new particle the index of the old particle that it replaces, or -1");
  };
  if (edit.from.size() != edit.object.positions.size())
    refuse("", "has " + std::to_string(edit.object.positions.size()) + " particles, but the edit says of " +
                   std::to_string(edit.from.size()) + " where they come from");
  for (std::size_t i = 0; i < edit.from.size(); ++i)
    if (edit.from[i] < -1 || edit.from[i] >= old.user_particles)
      refuse("particle " + std::to_string(i),
             "replaces particle " + std::to_string(edit.from[i]) + ", which does not exist");
  require_room(world.model, edit.object.positions.size() + edit.object.attachments.size(), edit.object.name);
}

/// Removes the contacts of rigid bodies with a collider. Later colliders move up by one.
void forget_contacts_of_collider(WorldData& world, int collider) {
  const int owner = -1 - collider;
  std::erase_if(world.state.body_contacts,
                [&](const BodyContact& contact) { return contact.a.owner == owner || contact.b.owner == owner; });
  for (BodyContact& contact : world.state.body_contacts)
    for (ContactPart* part : {&contact.a, &contact.b})
      if (part->owner < owner) ++part->owner;
}

/// For each object that can collide by edges and triangles: prepares these, which depend on the colliders.
void prepare_shape_contacts(WorldData& world) {
  world.groups.bodies_meet_others = true;
  for (int o = 0; o < static_cast<int>(world.model.objects.size()); ++o)
    world.workspace.shape_contacts.prepare(world.model, o);
}

}  // namespace

ObjectId World::add(const Object& object) {
  refuse_grave(object);
  require_room(data_->model, object.positions.size() + object.attachments.size(), object.name);
  const Sweep sweep = sweep_for(*data_, object);
  require_accelerable(*data_, sweep, object.name);
  CompiledObject compiled = compile(object, compile_options(*data_, sweep));
  refuse_intersections(*data_, compiled, {object.groups, object.mask}, false);
  const int number = data_->model.add(std::move(compiled));
  const ObjectId id = data_->ids.objects.add(number);
  keep_description(*data_, id.slot, &object);  // first, because the multipliers of what breaks are stored
  place_object(*data_, number);
  part_touching_starts(*data_, number);
  mark_overlaps(*data_, number);
  return id;
}

ColliderId World::add(const Collider& collider) {
  refuse_grave(collider);
  data_->model.colliders.push_back(collider);
  data_->state.rest_times.clear();  // bodies may be where it is
  wake_all_grains(*data_);
  prepare_shape_contacts(*data_);
  const ColliderId id = data_->ids.colliders.add(static_cast<int>(data_->model.colliders.size()) - 1);
  if (data_->kept_scene) data_->kept_scene->colliders[id.slot] = collider;
  return id;
}

MeshColliderId World::add(const MeshCollider& collider) {
  refuse_grave(collider);
  require_room(data_->model, collider.mesh.positions.size(), collider.name);
  CompiledObject compiled = compile(collider);
  const bool is_ground = collider.as == MeshCollider::As::heightfield;
  const Masks masks = is_ground ? Masks{0, 0} : Masks{collider.groups, collider.mask};
  refuse_intersections(*data_, compiled, masks, collider.as == MeshCollider::As::distance_grid);
  const int number = add_to_model(*data_, collider, std::move(compiled));
  place_object(*data_, number);
  const MeshColliderId id = data_->ids.mesh_colliders.add(number);
  if (data_->kept_scene) data_->kept_scene->mesh_colliders[id.slot] = collider;
  return id;
}

namespace {

/// What replaces an object that is edited.
struct Replacement {
  CompiledObject object;
  std::vector<int> news;  ///< for each old particle the first new index, or -1
};

Replacement compile_again(WorldData& world, ObjectId object, const Edit& edit) {
  const int number = world.number(object);
  refuse_grave(edit.object);
  require_origins(world, number, edit);
  const CompiledObject& old = world.model.objects[number];
  std::vector<int> news(old.user_particles, -1);
  for (int i = static_cast<int>(edit.from.size()); i-- > 0;)
    if (edit.from[i] >= 0) news[edit.from[i]] = i;
  const Sweep sweep = edit.object.sweep == Sweep::automatic ? old.sweep : edit.object.sweep;
  require_accelerable(world, sweep, edit.object.name);
  world.overstretch.forget_object(object.slot);
  world.convergence.forget_object(object);
  const std::optional<KeptSchedule> kept =
      sweep == old.sweep ? follow_edit(old, edit.object, edit.from) : std::optional<KeptSchedule>{};
  const KeptSchedule* const to_keep = kept ? &*kept : nullptr;
  return {compile(edit.object, compile_options(world, sweep), to_keep), std::move(news)};
}

}  // namespace

std::vector<int> edit_object(WorldData& world, ObjectId object, const Edit& edit) {
  Replacement by = compile_again(world, object, edit);
  keep_description(world, object.slot, &edit.object);
  replace_object(world, world.number(object), std::move(by.object), edit.from);
  mark_overlaps(world, world.number(object));
  return std::move(by.news);
}

void edit_object(WorldData& world, ObjectId object, Edit&& edit) {
  Replacement by = compile_again(world, object, edit);
  keep_description(world, object.slot, std::move(edit.object));
  replace_object(world, world.number(object), std::move(by.object), edit.from);
  mark_overlaps(world, world.number(object));
}

std::vector<int> World::edit(ObjectId object, const Edit& edit) { return edit_object(*data_, object, edit); }

void World::remove(ObjectId object) {
  remove_object(*data_, data_->number(object));
  data_->overstretch.forget_object(object.slot);
  data_->convergence.forget_object(object);
  forget_touching(*data_, object);
  keep_description(*data_, object.slot, nullptr);
  data_->ids.objects.remove(object);
}

void World::remove(ColliderId collider) {
  const int number = data_->ids.colliders.number(collider);
  forget_pose(*data_, false, collider.slot);
  forget_surface_velocities(*data_, SurfaceVelocity::Of::collider, collider.slot);
  forget_touching(*data_, collider);
  forget_contacts_of_collider(*data_, number);
  data_->ids.colliders.remove(collider);
  if (data_->kept_scene) data_->kept_scene->colliders.erase(collider.slot);
  data_->ids.colliders.close_gap(number);
  data_->model.colliders.erase(data_->model.colliders.begin() + number);
  data_->state.rest_times.clear();  // what lay on it wakes
  wake_all_grains(*data_);
  prepare_shape_contacts(*data_);
  std::map<int, PoseDrive> drives;  // by new numbers: a removal decreases larger ones by one
  for (const auto& [other, drive] : data_->workspace.control.colliders)
    if (other != number) drives.emplace(other > number ? other - 1 : other, drive);
  data_->workspace.control.colliders = std::move(drives);
}

void World::remove(MeshColliderId collider) {
  remove_object(*data_, data_->ids.mesh_colliders.number(collider));
  forget_pose(*data_, true, collider.slot);
  forget_surface_velocities(*data_, SurfaceVelocity::Of::mesh_collider, collider.slot);
  forget_touching(*data_, collider);
  data_->ids.mesh_colliders.remove(collider);
  if (data_->kept_scene) data_->kept_scene->mesh_colliders.erase(collider.slot);
}

bool World::has(ObjectId object) const { return data_->ids.objects.has(object); }
bool World::has(ColliderId collider) const { return data_->ids.colliders.has(collider); }
bool World::has(MeshColliderId collider) const { return data_->ids.mesh_colliders.has(collider); }

std::vector<ObjectId> World::objects() const { return data_->ids.objects.all(); }
std::vector<ColliderId> World::colliders() const { return data_->ids.colliders.all(); }
std::vector<MeshColliderId> World::mesh_colliders() const { return data_->ids.mesh_colliders.all(); }

std::optional<ObjectId> World::find(std::string_view object) const {
  return data_->ids.objects.first([&](int number) { return data_->model.objects[number].name == object; });
}
std::optional<ColliderId> World::find_collider(std::string_view name) const {
  return data_->ids.colliders.first([&](int number) { return data_->model.colliders[number].name == name; });
}
std::optional<MeshColliderId> World::find_mesh_collider(std::string_view name) const {
  return data_->ids.mesh_colliders.first([&](int number) { return data_->model.objects[number].name == name; });
}

int World::object_count() const { return data_->ids.objects.count(); }

}  // namespace pliant
