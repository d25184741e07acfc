// Worlds that keep the descriptions of what is in them (KeepDescription).
#include "pliant/error.h"
#include "world/tearing.h"
#include "world/world_data.h"

namespace pliant {

namespace {

/// Keeps all that a scene describes; the World was made of it, so that its ids are in the scene's order.
void keep_all(WorldData& world, const Scene& scene) {
  KeptScene& kept = world.kept_scene.emplace();
  kept.rest = without_things(scene);
  const std::vector<ObjectId> objects = world.ids.objects.all();
  for (std::size_t i = 0; i < objects.size(); ++i) keep_description(world, objects[i].slot, &scene.objects[i]);
  const std::vector<ColliderId> colliders = world.ids.colliders.all();
  for (std::size_t i = 0; i < colliders.size(); ++i) kept.colliders[colliders[i].slot] = scene.colliders[i];
  const std::vector<MeshColliderId> meshes = world.ids.mesh_colliders.all();
  for (std::size_t i = 0; i < meshes.size(); ++i) kept.mesh_colliders[meshes[i].slot] = scene.mesh_colliders[i];
}

}  // namespace

World::World(const Scene& scene, KeepDescription) : World(scene) { keep_all(*data_, scene); }
World::World(const Scene& scene, const WorldLayout& layout, KeepDescription) : World(scene, layout) {
  keep_all(*data_, scene);
}

bool World::keeps_description() const { return data_->kept_scene.has_value(); }

Scene World::description() const {
  if (!data_->kept_scene)
    throw Error({}, "the World has not kept its description", "make it with KeepDescription, or keep the Scene");
  Scene scene = data_->kept_scene->rest;
  scene.objects.reserve(data_->descriptions.size());
  scene.colliders.reserve(data_->kept_scene->colliders.size());
  scene.mesh_colliders.reserve(data_->kept_scene->mesh_colliders.size());
  // Maps are in the order of slots, as the ids are.
  for (const auto& [slot, object] : data_->descriptions) scene.objects.push_back(object);
  for (const auto& [slot, collider] : data_->kept_scene->colliders) scene.colliders.push_back(collider);
  for (const auto& [slot, collider] : data_->kept_scene->mesh_colliders) scene.mesh_colliders.push_back(collider);
  return scene;
}

}  // namespace pliant
