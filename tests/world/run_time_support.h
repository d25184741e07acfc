// What the tests of a World at run time share.
#pragma once

#include "world/world_support.h"

namespace pliant::testing_support {

/// A closed box about the origin; its triangles face outward.
inline TriangleMesh box_mesh(const Vec3f& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({(i & 1) != 0 ? size.x / 2 : -size.x / 2, (i & 2) != 0 ? size.y / 2 : -size.y / 2,
                              (i & 4) != 0 ? size.z / 2 : -size.z / 2});
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

inline double mass_of(const Object& object) {
  double sum = 0;
  for (const float mass : object.masses) sum += double(mass);
  return sum;
}

/// The linear momentum of an object's dynamic particles [kg m/s].
inline Vec3<double> momentum(const World& world, ObjectId object) {
  Vec3<double> sum{};
  const auto positions = world.object(object).positions_in_storage_order(),
             velocities = world.object(object).velocities_in_storage_order();
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions[i].w > 0)
      sum += Vec3<double>{double(velocities[i].x), double(velocities[i].y), double(velocities[i].z)} *
             (1 / double(positions[i].w));
  return sum;
}

}  // namespace pliant::testing_support
