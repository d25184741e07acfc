// Objects come and go. Each has a number in the model, a block in the State and its own part of the workspace, so that adding or
// removing one costs what that one costs. Contact among surfaces is prepared anew, once, before the next step.
#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "collision/fields/solid_fields.h"
#include "inspect/inspect_scene.h"
#include "math/motion.h"
#include "pliant/error.h"
#include "solver/sweeps/chains.h"
#include "solver/sweeps/sweep.h"
#include "world/implementation.h"

namespace pliant {

namespace {

/// Those that are asked for; else those that a second pass needs or that say how much of a length is meant.
Multipliers kept_multipliers(const Settings& settings) {
  if (settings.record_multipliers || settings.record_residuals) return Multipliers::all;
  const bool more_passes = settings.iterations * sweep_method(settings.sweep).passes > 1;
  return more_passes || settings.measure ? Multipliers::needed : Multipliers::none;
}

constexpr int most_particles = std::numeric_limits<int>::max() / 4;

void require_room(const Model& model, std::size_t particles, const std::string& name) {
  if (particles > static_cast<std::size_t>(most_particles - model.particles()))
    throw Error({.object = name}, "its particles and those of the World are more than can be numbered",
                "make it smaller, or remove others first");
}

/// What is moved by keyframes is where they have it by now, not where it would have begun.
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

}  // namespace

CompileOptions World::Implementation::compile_options() const {
  CompileOptions options;
  options.passes = settings.substeps * settings.iterations * sweep_method(settings.sweep).passes;
  options.in_given_order = settings.sweep == Sweep::natural;
  options.chains = settings.sweep == Sweep::chains;
  options.chain_softness = settings.sweep_options.chain_softness;
  options.tethers = settings.sweep_options.tethers;
  options.tether_slack = settings.sweep_options.tether_slack;
  options.multigrid = settings.sweep == Sweep::multigrid;
  options.gravity = length(model.gravity);
  return options;
}

int World::Implementation::add_to_model(const MeshCollider& collider) {
  if (collider.as == MeshCollider::As::triangles) return model.add(compile(collider));
  auto field = solid_field_of(collider);
  const int number = model.add(compile(collider));
  model.fields.push_back({number, std::move(field), collider.motion, collider.thickness, collider.static_friction,
                          collider.kinetic_friction, collider.restitution, collider.groups, collider.mask});
  return number;
}

void World::Implementation::put(int number) {
  put_at_start(model, number, state);
  if (state.time != 0) move_to_present(model.objects[number], state.time, &state.positions[model.first[number]]);
  prepare(number);
  note_surfaces(number);
}

void World::Implementation::remove(int number) {
  note_surfaces(number);
  const auto first = static_cast<std::size_t>(model.first[number]);
  const auto particles = static_cast<std::size_t>(model.objects[number].particles);
  for (Records* records : {&state.positions, &state.remainders, &state.velocities, &workspace.displacements})
    std::fill_n(records->begin() + static_cast<std::ptrdiff_t>(first), particles, Record{});
  model.remove(number);
  forget_control(number);
  std::erase_if(model.fields, [&](const FieldCollider& field) { return field.object == number; });
  state.blocks[number] = {0, 0, model.generation[number]};
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->resize(model.particles());
  prepare(number);
}

void World::Implementation::forget_control(int number) {
  workspace.control.objects.erase(number);
  workspace.control.meshes.erase(number);
}

void World::Implementation::prepare(int number) {
  pliant::prepare(model, number, kept_multipliers(settings), workspace);
  prepare_sweep(model, number, settings, workspace);
  prepare_chains(model, number, executor.threads(), workspace);
  objects_changed = true;
}

void World::Implementation::note_surfaces(int number) {
  const CompiledObject& object = model.objects[number];
  const auto is_mesh = [](const CompiledObject& one) { return one.is_collider && one.groups != 0; };
  surfaces_changed = surfaces_changed || pair_model != nullptr || object.self_collision ||
                     (object.collides && object.groups != 0) ||
                     std::any_of(model.objects.begin(), model.objects.end(), is_mesh);
}

void World::Implementation::require_origins(int number, const Edit& edit) const {
  const CompiledObject& old = model.objects[number];
  const auto refuse = [&](const std::string& element, const std::string& problem) {
    throw Error({.object = edit.object.name, .element = element}, problem, "give for each particle the one it was, or -1");
  };
  if (edit.from.size() != edit.object.positions.size())
    refuse("", "has " + std::to_string(edit.object.positions.size()) + " particles and " +
                   std::to_string(edit.from.size()) + " origins");
  for (std::size_t i = 0; i < edit.from.size(); ++i)
    if (edit.from[i] < -1 || edit.from[i] >= old.user_particles)
      refuse("particle " + std::to_string(i),
             "comes from particle " + std::to_string(edit.from[i]) + ", which does not exist");
  require_room(model, edit.object.positions.size() + edit.object.attachments.size(), edit.object.name);
}

void World::Implementation::replace(int number, CompiledObject by, const std::vector<int>& from) {
  note_surfaces(number);
  const CompiledObject& old = model.objects[number];
  const int first = model.first[number], particles = old.particles;
  // Targets of attachments follow the particles, and are the same as far as there were as many.
  const auto origin = [&](int user) {
    const int at = user < by.user_particles ? from[user] : user - by.user_particles + old.user_particles;
    return at < 0 || at >= particles ? -1 : first + old.place[at];
  };
  std::vector<std::array<Record, 3>> kept(by.order.size());
  std::vector<char> is_kept(by.order.size(), 0);
  for (std::size_t i = 0; i < by.order.size(); ++i) {
    const int at = origin(by.order[i]);
    if (at < 0) continue;
    is_kept[i] = 1;
    kept[i] = {state.positions[at], state.remainders[at], state.velocities[at]};
  }
  for (Records* records : {&state.positions, &state.remainders, &state.velocities, &workspace.displacements})
    std::fill_n(records->begin() + first, particles, Record{});
  forget_control(number);
  model.replace(number, std::move(by));
  put(number);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    const auto at = static_cast<std::size_t>(model.first[number]) + i;
    Record& x = state.positions[at];
    x = {kept[i][0].x, kept[i][0].y, kept[i][0].z, x.w};
    state.remainders[at] = kept[i][1];
    state.velocities[at] = x.w > 0 ? kept[i][2] : Record{};
  }
}

void World::Implementation::forget_pose(bool is_mesh, int slot) {
  std::erase_if(state.held_poses, [&](const HeldPose& pose) { return pose.is_mesh == is_mesh && pose.slot == slot; });
}

void World::Implementation::prepare_pairs() {
  workspace.pairs = nullptr;
  pair_model = make_pair_model(model, initial_state(model).positions);
  surfaces_changed = false;
  if (pair_model == nullptr) return;
  pair_model->filter = settings.contact_filter;
  if (settings.initial_intersections == Settings::Intersections::untangle)
    pair_model->untangling_speed = settings.untangling_speed;
  workspace.pairs = std::make_unique<SurfaceContact>(*pair_model, kernels.pairs);
  workspace.look_for_tangles = true;
}

void World::Implementation::bring_up_to_date() {
  if (surfaces_changed) prepare_pairs();
  if (!objects_changed) return;
  for (TileScratch& tile : workspace.tiles) tile.contacts.clear();  // tasks have moved up
  if (settings.tolerance > 0) prepare_residual(model, workspace.residual);
  objects_changed = false;
}

// ---------------------------------------------------------------- World

ObjectId World::add(const Object& object) {
  refuse_grave(object);
  require_room(self_->model, object.positions.size() + object.attachments.size(), object.name);
  const int number = self_->model.add(compile(object, self_->compile_options()));
  self_->put(number);
  return self_->object_ids.add(number);
}

ColliderId World::add(const Collider& collider) {
  refuse_grave(collider);
  self_->model.colliders.push_back(collider);
  return self_->collider_ids.add(static_cast<int>(self_->model.colliders.size()) - 1);
}

MeshColliderId World::add(const MeshCollider& collider) {
  refuse_grave(collider);
  require_room(self_->model, collider.mesh.positions.size(), collider.name);
  const int number = self_->add_to_model(collider);
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
  self_->replace(number, compile(edit.object, self_->compile_options()), edit.from);
  return news;
}

void World::remove(ObjectId object) {
  self_->remove(self_->number(object));
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
  std::map<int, PoseDrive> drives;  // of those above it the numbers are one less
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
