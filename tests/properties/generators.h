// Random inputs that rapidcheck can shrink: meshes, stencils and small scenes with cloth.
#pragma once

#include <rapidcheck.h>

#include <array>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::properties {

/// A float in [low, high], one of `steps` equidistant values, so that shrinking ends.
inline rc::Gen<float> between(float low, float high, int steps = 1000) {
  return rc::gen::map(rc::gen::inRange(0, steps + 1),
                      [=](int i) { return low + (high - low) * static_cast<float>(i) / static_cast<float>(steps); });
}

/// A point in the cube [-reach, reach]^3 [m].
inline Vec3f point(float reach) {
  const float x = *between(-reach, reach), y = *between(-reach, reach), z = *between(-reach, reach);
  return {x, y, z};
}

/// Triangles among `vertices` points. No triangle has a corner twice, but triangles may repeat and cross.
inline TriangleMesh soup(int vertices, int triangles, float reach) {
  TriangleMesh mesh;
  for (int i = 0; i < vertices; ++i) mesh.positions.push_back(point(reach));
  for (int i = 0; i < triangles; ++i) {
    const int a = *rc::gen::inRange(0, vertices), b = *rc::gen::inRange(1, vertices),
              c = *rc::gen::inRange(1, vertices);
    const std::array<int, 3> corners{a, (a + b) % vertices, (a + c) % vertices};
    if (corners[1] != corners[2]) mesh.triangles.push_back(corners);
  }
  return mesh;
}

/// `count` stencils, each of `size` different particles out of `particles`.
inline std::vector<int> stencils(int count, int size, int particles) {
  std::vector<int> all;
  for (int i = 0; i < count; ++i) {
    const auto of = *rc::gen::unique<std::vector<int>>(static_cast<std::size_t>(size), rc::gen::inRange(0, particles));
    all.insert(all.end(), of.begin(), of.end());
  }
  return all;
}

/// One or two sheets of cloth over a ball or the ground, with any sweep; they may collide with themselves and each
/// other.
inline Scene small_scene() {
  Scene scene;
  const int sheets = *rc::gen::inRange(1, 3);
  for (int i = 0; i < sheets; ++i) {
    const int columns = *rc::gen::inRange(2, 9), rows = *rc::gen::inRange(2, 9);
    ClothOptions options;
    options.name = "sheet " + std::to_string(i);
    options.material = fabric(*rc::gen::element<std::string>("cotton", "silk", "denim"));
    Object object = make_cloth(
        grid_mesh(columns, rows, 0.1f * static_cast<float>(columns), 0.1f * static_cast<float>(rows)), options);
    for (Vec3f& x : object.positions) x.y += 0.05f + 0.03f * static_cast<float>(i);
    object.thickness = 0.004f;
    object.self_collision = *rc::gen::arbitrary<bool>();
    object.collides = *rc::gen::arbitrary<bool>();
    if (*rc::gen::arbitrary<bool>()) object.pins.push_back({0, {}});
    scene.add(object);
  }
  Collider ground;
  if (*rc::gen::arbitrary<bool>()) ground.shape = Sphere{0.04f};
  scene.add(ground);
  scene.settings.sweep =
      *rc::gen::element(Sweep::automatic, Sweep::tiled, Sweep::chains, Sweep::multigrid, Sweep::jacobi);
  scene.settings.substeps = *rc::gen::inRange(1, 6);
  scene.settings.iterations = *rc::gen::inRange(1, 4);
  scene.settings.threads = 1;
  return scene;
}

}  // namespace pliant::properties
