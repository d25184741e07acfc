// A tank of planes without friction, and liquid in it.
#pragma once

#include "apps/validate/rows.h"
#include "pliant/liquid.h"

namespace pliant::validate {

inline constexpr float gravity_in_float = 9.81f;  ///< [m/s^2]

/// Adds a tank from the origin to `size` [m], open above.
inline void add_tank(Scene& scene, const Vec3f& size, bool with_floor = true) {
  const auto add = [&](const char* name, const Vec3f& at, const Vec3f& axis, float degrees) {
    Collider plane;
    plane.name = name;
    plane.position = at;
    plane.rotation = rotation(axis, degrees);
    plane.static_friction = plane.kinetic_friction = 0;
    scene.add(plane);
  };
  if (with_floor) add("floor", {}, {0, 0, 1}, 0);
  add("left", {}, {0, 0, 1}, -90);
  add("right", {size.x, 0, 0}, {0, 0, 1}, 90);
  add("back", {}, {1, 0, 0}, 90);
  add("front", {0, 0, size.z}, {1, 0, 0}, -90);
}

/// A scene of particles of water, 1000 kg/m^3, with the default settings and frames of 1/60 s. `spacing` in m.
inline Scene water_scene(const std::vector<Vec3f>& places, float spacing) {
  Scene scene;
  scene.gravity = {0, -gravity_in_float, 0};
  scene.frame_time = frame_time;
  scene.settings.threads = 1;
  scene.add(make_liquid(places, {.name = "water", .fluid = {.spacing = spacing}}));
  return scene;
}

/// A tank as long as `tank_length`, filled from the origin to `filled` [m].
inline Scene tank_scene(const Vec3f& filled, float spacing, float tank_length) {
  Scene scene = water_scene(fill_box({}, filled, spacing), spacing);
  add_tank(scene, {tank_length, filled.y, filled.z});
  return scene;
}

}  // namespace pliant::validate
