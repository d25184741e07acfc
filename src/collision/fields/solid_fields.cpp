#include "collision/fields/solid_fields.h"

#include <algorithm>

#include "pliant/error.h"

namespace pliant {

namespace {

constexpr float cells_along_longest = 48, padding_cells = 2;

void require_known(const MeshCollider& collider) {
  if (collider.field) {
    DistanceGrid checked(collider.field);
  } else {
    require_closed(collider.mesh.triangles, static_cast<int>(collider.mesh.positions.size()));
  }
}

}  // namespace

std::shared_ptr<const DistanceField> measure_distances(const TriangleMesh& mesh, float spacing) {
  require_indices(mesh.triangles, static_cast<int>(mesh.positions.size()));
  const MeshQuery query(mesh.positions, mesh.triangles);
  if (spacing == 0 && !mesh.triangles.empty()) {
    const Vec3f sides = query.bounds().high - query.bounds().low;
    spacing = std::max({sides.x, sides.y, sides.z}) / cells_along_longest;
  }
  Executor executor(0);
  return DistanceGrid(query, spacing, padding_cells * spacing, executor).field();
}

std::shared_ptr<const SolidField> solid_field_of(const MeshCollider& collider) {
  if (collider.as == MeshCollider::As::heightfield) return std::make_shared<SolidField>(heightfield_of(collider.mesh));
  const auto field = collider.field ? collider.field : measure_distances(collider.mesh, collider.grid_spacing);
  return std::make_shared<SolidField>(DistanceGrid(field));
}

void require_solid(const MeshCollider& collider) {
  if (collider.as == MeshCollider::As::heightfield) heightfield_of(collider.mesh);
  if (collider.as == MeshCollider::As::distance_grid) require_known(collider);
}

}  // namespace pliant
