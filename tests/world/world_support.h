// What the tests of a World share.
#pragma once

#include <cmath>
#include <string>

#include "support/scenes.h"

namespace pliant::testing_support {

inline constexpr float dt = 1.f / 60;

inline bool is_finite(const State& state) {
  for (const auto* records : {&state.positions, &state.remainders, &state.velocities}) {
    for (const Record& r : *records) {
      if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z) || !std::isfinite(r.w)) return false;
    }
  }
  return std::isfinite(state.time);
}

/// A scene of cloth that hangs by two corners over a moving ball.
inline Scene hanging_cloth() {
  Scene scene;
  const int cloth = scene.add_cloth(grid_mesh(12, 12, 1, 1));
  scene.pin(cloth, {0, 11});
  Collider ball;
  ball.shape = Sphere{0.3f};
  ball.position = {0, -0.5f, 0};
  ball.motion = straight({0.2f, 0, 0}, 1);
  scene.add(ball);
  scene.settings = settings_of(8);
  return scene;
}

/// A level sheet of n x n vertices with its middle at a given position [m].
inline Object sheet_at(const std::string& name, const Vec3f& at, int n, float size, const ClothOptions& like = {}) {
  ClothOptions options = like;
  options.name = name;
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  for (Vec3f& p : mesh.positions) p += at;
  return make_cloth(mesh, options);
}

}  // namespace pliant::testing_support
