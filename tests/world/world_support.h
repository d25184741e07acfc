// What the tests of a World share.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/error.h"
#include "support/scenes.h"

namespace pliant::testing_support {

inline constexpr float dt = 1.f / 60;
inline constexpr float float_pi = 3.14159265f;

inline bool is_finite(const State& state) {
  for (const auto* records : {&state.positions, &state.remainders, &state.velocities}) {
    for (const Record& r : *records) {
      if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z) || !std::isfinite(r.w)) return false;
    }
  }
  return std::isfinite(state.time);
}

/// The message of the Error for which making a World of a scene fails; empty if it succeeds.
inline std::string refusal_of(const Scene& scene) {
  try {
    const World world(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The speed of the fastest particle or body [m/s].
inline float fastest(const World& world) {
  float speed = 0;
  for (const Record& v : world.state().velocities)
    speed = std::max(speed, std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
  return speed;
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

inline Collider floor_at(float height) {
  Collider floor;
  floor.position = {0, height, 0};
  return floor;
}

inline double distance(const Vec3f& a, const Vec3f& b) { return std::sqrt(static_cast<double>(length_squared(a - b))); }

/// A level sheet of n x n vertices with its middle at a given position [m].
inline Object sheet_at(const std::string& name, const Vec3f& at, int n, float size, const ClothOptions& like = {}) {
  ClothOptions options = like;
  options.name = name;
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  for (Vec3f& p : mesh.positions) p += at;
  return make_cloth(mesh, options);
}

}  // namespace pliant::testing_support
