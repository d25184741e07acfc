// What a World's handle refers to.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <string>

#include "handles.h"
#include "pliant/world.h"

namespace pliant::c {

/// A World, what a run of its scene is like, and how its last step went.
struct WorldHandle {
  WorldHandle(World made, float time, int run) : world(std::move(made)), frame_time(time), frames(run) {}
  World world;
  float frame_time;  ///< [s]
  int frames;
  Report report{};
  bool records_joint_loads = false, records_contacts = false;
  std::string folder = ".";  ///< of the paths in what is added
  std::atomic<bool> is_stepping{false};
};

/// The World of a handle, which is not in a step. Throws a StatusError if it is, or if the handle is stale.
inline std::shared_ptr<WorldHandle> at(const pliant_world* handle) {
  auto world = at<pliant_world>(handle);
  if (world->is_stepping) throw StatusError(PLIANT_BUSY, "the World is in a step", "call again after it");
  return world;
}

/// A number by its name.
template <class... Of>
struct NamedNumber {
  const char* name;
  double (*value)(Of...);
};

/// The number of that name in a list; null if there is none.
template <size_t count, class... Of>
const NamedNumber<Of...>* find_number(const NamedNumber<Of...> (&numbers)[count], const char* name) {
  const auto has_name = [&](const NamedNumber<Of...>& number) { return std::strcmp(number.name, name) == 0; };
  const auto* found = std::find_if(numbers, numbers + count, has_name);
  return found == numbers + count ? nullptr : found;
}

/// The id of an object that exists. Throws a StatusError if it is stale or of another kind.
ObjectId object_id(const World& world, pliant_id id);
ColliderId collider_id(const World& world, pliant_id id);
MeshColliderId mesh_collider_id(const World& world, pliant_id id);

/// Calls `body` with the id in the library's type, of whatever kind it is.
template <class Body>
void for_any_kind(const World& world, pliant_id id, const Body& body) {
  if (id.kind == PLIANT_COLLIDER) return body(collider_id(world, id));
  if (id.kind == PLIANT_MESH_COLLIDER) return body(mesh_collider_id(world, id));
  body(object_id(world, id));
}

}  // namespace pliant::c
