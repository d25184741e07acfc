// What the tests of liquids share.
#pragma once

#include <cmath>

#include "pliant/scene.h"

namespace pliant::testing_support {

inline constexpr float liquid_spacing = 0.05f;  // of particles [m]

inline Collider wall(const Vec3f& at, const Quatf& rotation) {
  Collider plane;
  plane.position = at;
  plane.rotation = rotation;
  plane.static_friction = plane.kinetic_friction = 0;
  return plane;
}

/// A tank of planes around the box from the origin to `size`, open above.
inline void add_tank(Scene& scene, const Vec3f& size) {
  const float r = std::sqrt(0.5f);
  scene.add(wall({0, 0, 0}, {0, 0, 0, 1}));
  scene.add(wall({0, 0, 0}, {0, 0, -r, r}));
  scene.add(wall({size.x, 0, 0}, {0, 0, r, r}));
  scene.add(wall({0, 0, 0}, {r, 0, 0, r}));
  scene.add(wall({0, 0, size.z}, {-r, 0, 0, r}));
}

}  // namespace pliant::testing_support
