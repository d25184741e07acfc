// Tests an object that is to be added for intersections with the World's surfaces, if the settings refuse them.
#include "world/intersections.h"

#include <utility>

#include "inspect/inspect_scene.h"
#include "world/object_store.h"

namespace pliant {

namespace {

/// Collision groups of a temporary scene, in which the new surface meets the present ones, but these do not meet each
/// other.
constexpr std::uint32_t of_present = 1, of_new = 2;

/// The triangle mesh of a compiled object in the user's order, at the given positions.
TriangleMesh mesh_of(const CompiledObject& of, const Record* positions) {
  TriangleMesh mesh;
  for (int user = 0; user < of.user_particles; ++user) {
    const Record& r = positions[of.place[user]];
    mesh.positions.push_back({r.x, r.y, r.z});
  }
  for (const auto& t : of.surface.triangles) mesh.triangles.push_back({of.order[t[0]], of.order[t[1]], of.order[t[2]]});
  return mesh;
}

struct Part {
  const CompiledObject& of;
  TriangleMesh mesh;
  std::uint32_t groups, mask;
};

void add_part(Part part, bool self_collision, MeshCollider::As as, Scene& scene) {
  if (part.of.is_collider) {
    MeshCollider& collider = scene.mesh_colliders.emplace_back();
    collider.name = part.of.name;
    collider.mesh = std::move(part.mesh);
    collider.as = as;
    collider.groups = part.groups;
    collider.mask = part.mask;
    return;
  }
  Object& object = scene.objects.emplace_back();
  object.name = part.of.name;
  object.positions = std::move(part.mesh.positions);
  object.triangles = std::move(part.mesh.triangles);
  object.collides = part.of.collides;
  object.self_collision = self_collision;
  object.groups = part.groups;
  object.mask = part.mask;
}

}  // namespace

void refuse_intersections(const WorldData& world, const CompiledObject& added, const Masks& masks, bool is_grid) {
  if (world.settings.initial_intersections != Settings::Intersections::refuse) return;
  Records now(added.positions.begin(), added.positions.end());
  move_to_present(added, world.state.time, now.data());
  Scene scene;
  scene.settings.initial_intersections = Settings::Intersections::refuse;
  const auto as = [](bool grid) { return grid ? MeshCollider::As::distance_grid : MeshCollider::As::triangles; };
  add_part({added, mesh_of(added, now.data()), of_new, of_present}, added.self_collision, as(is_grid), scene);
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number) {
    const CompiledObject& other = world.model.objects[number];
    Masks of_other{other.groups, other.mask};
    bool other_is_grid = false;
    for (const FieldCollider& field : world.model.fields) {
      if (field.object != number) continue;
      of_other = {field.groups, field.mask};
      other_is_grid = !field.field->is_ground();
      if (!other_is_grid) of_other = {0, 0};  // heightfields have no inside
    }
    if ((of_other.groups & masks.mask) == 0 || (masks.groups & of_other.mask) == 0) continue;
    add_part({other, mesh_of(other, &world.state.positions[world.model.first[number]]), of_present, of_new}, false,
             as(other_is_grid), scene);
  }
  pliant::refuse_initial_intersections(scene);
}

}  // namespace pliant
