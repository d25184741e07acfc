// Functions that add to a Scene. World and inspect() validate what is added.
#include "pliant/scene.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pliant/error.h"

namespace pliant {

int Scene::add(Object object) {
  objects.push_back(std::move(object));
  return static_cast<int>(objects.size()) - 1;
}

int Scene::add(Collider collider) {
  colliders.push_back(std::move(collider));
  return static_cast<int>(colliders.size()) - 1;
}

int Scene::add(MeshCollider collider) {
  mesh_colliders.push_back(std::move(collider));
  return static_cast<int>(mesh_colliders.size()) - 1;
}

int Scene::add_cloth(const TriangleMesh& mesh, const ClothOptions& options) { return add(make_cloth(mesh, options)); }

void Scene::pin(int object, const std::vector<int>& particles, const Motion& motion) {
  if (object < 0 || object >= static_cast<int>(objects.size()))
    throw Error({"", 0, "", "object " + std::to_string(object)},
                "does not exist; the scene has " + std::to_string(objects.size()) + " objects",
                "use an index that add() or add_cloth() returned");
  Object& pinned = objects[static_cast<std::size_t>(object)];
  // All indices are validated before the first particle is pinned, so that an error leaves the scene unchanged.
  for (int particle : particles)
    if (particle < 0 || particle >= static_cast<int>(pinned.positions.size()))
      throw Error({"", 0, pinned.name, "particle " + std::to_string(particle)},
                  "does not exist; there are " + std::to_string(pinned.positions.size()) + " particles",
                  "indices count from 0");
  for (int particle : particles) pinned.pins.push_back({particle, motion});
}

}  // namespace pliant
