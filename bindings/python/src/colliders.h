// References from Python to colliders of a World.
#pragma once

#include <string>
#include <utility>

#include "bindings.h"

namespace pliant::python {

struct ColliderRef {
  SharedWorld world;
  ColliderId id;
  std::string name;
  ColliderView view() const { return std::as_const(world->idle()).collider(id); }
  ColliderHandle handle() const { return world->idle().collider(id); }
};

struct MeshColliderRef {
  SharedWorld world;
  MeshColliderId id;
  std::string name;
  MeshColliderView view() const { return std::as_const(world->idle()).mesh_collider(id); }
  MeshColliderHandle handle() const { return world->idle().mesh_collider(id); }
};

}  // namespace pliant::python
