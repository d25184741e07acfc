// Colliders of both kinds.
#include "memory.h"
#include "world_handle.h"

namespace pliant::c {

namespace {

/// Calls `body` with the handle of a collider of either kind. Throws a StatusError for the id of an object.
template <class Body>
void with_collider(const pliant_world* world, pliant_id id, const Body& body) {
  const auto of = at(world);
  World& in = of->world;
  if (id.kind == PLIANT_MESH_COLLIDER) return body(in.mesh_collider(mesh_collider_id(in, id)));
  body(in.collider(collider_id(in, id)));
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_collider_pose(const pliant_world* world, pliant_id collider, pliant_pose* pose) {
  return guarded([&] {
    const auto of = at(world);
    give_pose(of->world.collider(collider_id(of->world, collider)).pose(), pose);
  });
}

pliant_status pliant_collider_set_pose(pliant_world* world, pliant_id collider, const pliant_pose* pose) {
  return guarded(
      [&] { with_collider(world, collider, [&](auto handle) { handle.set_pose(c::pose_of(pose, "pose")); }); });
}

pliant_status pliant_collider_teleport(pliant_world* world, pliant_id collider, const pliant_pose* by) {
  return guarded([&] { with_collider(world, collider, [&](auto handle) { handle.teleport(c::pose_of(by, "by")); }); });
}

pliant_status pliant_collider_set_surface_velocity(pliant_world* world, pliant_id collider, const float* velocity) {
  return guarded([&] {
    with_collider(world, collider, [&](auto handle) { handle.set_surface_velocity(vector_of(velocity, "velocity")); });
  });
}

pliant_status pliant_collider_positions(const pliant_world* world, pliant_id collider, float* into, size_t capacity,
                                        size_t* count) {
  return guarded([&] {
    const auto of = at(world);
    const World& in = of->world;
    const auto mesh = in.mesh_collider(mesh_collider_id(in, collider));
    const auto vertices = static_cast<size_t>(mesh.vertex_count());
    if (tell<float>({into, capacity, count}, vertices, "vertices")) mesh.read_positions(points(into, vertices, "into"));
  });
}

pliant_status pliant_collider_set_positions(pliant_world* world, pliant_id collider, const float* positions,
                                            size_t count) {
  return guarded([&] {
    const auto of = at(world);
    const MeshColliderId id = mesh_collider_id(of->world, collider);
    of->world.mesh_collider(id).set_positions(points(positions, count, "positions"));
  });
}
