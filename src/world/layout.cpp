// Makes a World from its WorldLayout: with the same ids as after the objects and colliders were added and removed.
#include <limits>
#include <set>
#include <string>

#include "inspect/inspect_scene.h"
#include "matter/advice_settings.h"
#include "model/keep_schedule.h"
#include "model/layout.h"
#include "pliant/error.h"
#include "world/groups.h"
#include "world/object_store.h"
#include "world/rest.h"
#include "world/soaking.h"
#include "world/tearing.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const std::string& problem) {
  throw Error({}, "the layout does not fit the scene: " + problem,
              "use the scene and the layout() of the same World at the same time");
}

/// Upper limit of numbers and generations in a layout. It is far below the largest int, so that counting on cannot
/// overflow.
constexpr int largest_number = std::numeric_limits<int>::max() / 4;

/// The numbers of the slots in use. Throws an Error unless there are `count`, each below `taken.size()` and used once.
std::vector<int> numbers_in(const std::vector<WorldLayout::Slot>& slots, std::size_t count, std::vector<char>& taken) {
  std::vector<int> numbers;
  for (const WorldLayout::Slot& slot : slots) {
    if (slot.generation < 0 || slot.generation > largest_number)
      refuse("generation " + std::to_string(slot.generation) + " is out of range");
    if (slot.number < 0) continue;
    if (slot.number >= static_cast<int>(taken.size()) || taken[slot.number] != 0)
      refuse("number " + std::to_string(slot.number) + " does not exist or is given twice");
    taken[slot.number] = 1;
    numbers.push_back(slot.number);
  }
  if (numbers.size() != count)
    refuse("it has " + std::to_string(numbers.size()) + " slots in use, and the scene " + std::to_string(count) +
           " objects or colliders for them");
  return numbers;
}

/// Removes the pairs that name an object that is missing. A World keeps these for an object of that name added later.
Scene without_pairs_of_others(const Scene& scene) {
  std::set<std::string> names;
  for (const Object& object : scene.objects) names.insert(object.name);
  for (const MeshCollider& collider : scene.mesh_colliders) names.insert(collider.name);
  Scene own = scene;
  std::erase_if(own.pairs,
                [&](const PairProperties& pair) { return names.count(pair.first) * names.count(pair.second) == 0; });
  return own;
}

void require_place(const StateBlock& block, int first_frame, const CompiledObject& object) {
  const auto is_in_range = [](int value) { return value >= 0 && value <= largest_number; };
  if (!is_in_range(block.first) || !is_in_range(block.generation) || !is_in_range(first_frame))
    refuse("the place of object '" + object.name + "' is out of range");
  if (block.particles != object.particles)
    refuse("object '" + object.name + "' has " + std::to_string(object.particles) + " particles, but a block of " +
           std::to_string(block.particles));
}

}  // namespace

Scene without_things(const Scene& scene) {
  Scene rest;
  rest.gravity = scene.gravity;
  rest.wind = scene.wind;
  rest.forces = scene.forces;
  rest.pairs = scene.pairs;
  rest.settings = scene.settings;
  rest.frame_time = scene.frame_time;
  rest.frames = scene.frames;
  return rest;
}

WorldData::WorldData(const Scene& scene, const WorldLayout& layout)
    : WorldData(without_things(scene), scene.settings, scene.settings) {
  open.sweep = open.sweep || layout.sweep_is_open;
  open.substeps = open.substeps || layout.substeps_are_open;
  Settings given = scene.settings;
  if (open.sweep) given.sweep = Sweep::automatic;
  if (open.substeps) given.substeps = 0;
  open.departs = departures(scene, given, scene.settings);
  const std::size_t count = layout.blocks.size();
  if (layout.first_frames.size() != count || layout.sweeps.size() != count || layout.schedules.size() != count)
    refuse("its columns differ in length");
  std::vector<char> taken(count, 0), taken_colliders(scene.colliders.size(), 0);
  const std::vector<int> of_objects = numbers_in(layout.objects, scene.objects.size(), taken),
                         of_meshes = numbers_in(layout.mesh_colliders, scene.mesh_colliders.size(), taken),
                         of_colliders = numbers_in(layout.colliders, scene.colliders.size(), taken_colliders);
  model.colliders.resize(scene.colliders.size());
  for (std::size_t i = 0; i < of_colliders.size(); ++i) model.colliders[of_colliders[i]] = scene.colliders[i];
  std::vector<CompiledObject> objects(count);
  for (std::size_t i = 0; i < of_objects.size(); ++i) {
    if (layout.sweeps[of_objects[i]] == Sweep::automatic) refuse("an object has no sweep");
    const KeptSchedule& kept = layout.schedules[of_objects[i]];
    objects[of_objects[i]] = compile(scene.objects[i], compile_options(*this, layout.sweeps[of_objects[i]]),
                                     kept.is_used() ? &kept : nullptr);
    if (kept.is_used() && !objects[of_objects[i]].additions.are_used)  // its particles would be stored in another order
      refuse("the schedule of object '" + scene.objects[i].name + "' is of other constraints, or of another stiffness");
  }
  for (std::size_t i = 0; i < of_meshes.size(); ++i) {
    objects[of_meshes[i]] = compile(scene.mesh_colliders[i]);
    add_field(*this, scene.mesh_colliders[i], field_of(scene.mesh_colliders[i]), of_meshes[i]);
  }
  std::vector<ObjectPlace> places;
  for (std::size_t number = 0; number < count; ++number) {
    const StateBlock& block = layout.blocks[number];
    if (taken[number] != 0) require_place(block, layout.first_frames[number], objects[number]);
    places.push_back({block.first, layout.first_frames[number], block.generation, taken[number] == 0});
  }
  lay_out(std::move(objects), places, model);
  ids.objects.restore(layout.objects);
  ids.colliders.restore(layout.colliders);
  ids.mesh_colliders.restore(layout.mesh_colliders);
  for (std::size_t i = 0; i < of_objects.size(); ++i)
    keep_description(*this, ids.objects.id_of(of_objects[i]).slot, &scene.objects[i]);
  open_liquids(*this);
  state = initial_state(model);
  for (std::size_t number = 0; number < count; ++number) {
    if (taken[number] == 0) state.blocks[number] = {0, 0, model.generation[number]};
    prepare_object(*this, static_cast<int>(number));
  }
  keep_flowed(*this);
  follow_rest_factors(*this, 0);
  groups.all.clear();  // groups of the World without objects
  groups.tables = nullptr;
  bring_up_to_date(*this);
}

World::World(const Scene& scene, const WorldLayout& layout) {
  refuse_grave_but_places(without_pairs_of_others(scene));
  data_ = std::make_unique<WorldData>(scene, layout);
}

WorldLayout World::layout() const {
  WorldLayout layout{data_->ids.objects.layout(),
                     data_->ids.colliders.layout(),
                     data_->ids.mesh_colliders.layout(),
                     data_->state.blocks,
                     data_->model.first_frame,
                     {},
                     {},
                     data_->open.sweep,
                     data_->open.substeps};
  for (const CompiledObject& object : data_->model.objects) {
    layout.sweeps.push_back(object.sweep);
    layout.schedules.push_back(object.additions.are_used ? schedule_of(object) : KeptSchedule{});
  }
  return layout;
}

}  // namespace pliant
