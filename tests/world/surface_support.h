// What the tests of surfaces that touch share: cloth that does, and sheets to make it of.
#pragma once

#include "world/world_support.h"

namespace pliant::testing_support {

/// Rigid cotton that meets itself and others.
inline Object cloth(const TriangleMesh& mesh, float thickness = 0.002f) {
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(mesh, options);
  object.thickness = thickness;
  object.self_collision = object.collides = true;
  return object;
}

/// n x n vertices, level.
inline TriangleMesh sheet(int n, float size, float height) {
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  for (Vec3f& p : mesh.positions) p.y += height;
  return mesh;
}

inline Scene scene_of(int substeps) {
  Scene scene;
  scene.settings = settings_of(substeps);
  return scene;
}

}  // namespace pliant::testing_support
