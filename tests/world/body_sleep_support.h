// Scenes of bodies that sleep.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant::testing_support {

inline constexpr int four_seconds = 240;

inline int add_colliding_body(Object& object, const SolidShape& shape, const Vec3f& position,
                              const Vec3f& velocity = {}) {
  BodyOptions options;
  options.position = position;
  options.velocity = velocity;
  options.mass = 1;
  object.collides = object.self_collision = true;
  return add_body(object, {{shape}}, options);
}

inline Scene sleeping_scene() {
  Scene scene;
  scene.settings.sleep.on = true;
  return scene;
}

inline Collider ground() {
  Collider plane;
  plane.name = "ground";
  return plane;
}

/// A pyramid of unit boxes on the plane y = 0.
inline Object light_pyramid(int base) {
  Object boxes;
  boxes.name = "pyramid";
  boxes.static_friction = boxes.kinetic_friction = 0.6f;
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i)
      add_colliding_body(boxes, Box{{.5f, .5f, .5f}},
                         {static_cast<float>(i) + 0.5f * static_cast<float>(row), 0.5f + static_cast<float>(row), 0});
  return boxes;
}

/// A box at rest on the plane, 2 m from the origin along z.
inline Object single_box() {
  Object box;
  box.name = "box";
  add_colliding_body(box, Box{{.5f, .5f, .5f}}, {0, .5f, 2});
  return box;
}

inline Report step(World& world) {
  Report report = world.step(dt);
  EXPECT_TRUE(report.ok()) << report.explain();
  return report;
}

/// Steps until so many bodies sleep; false if they do not within four seconds.
inline bool fall_asleep(World& world, int bodies) {
  for (int frame = 0; frame < four_seconds; ++frame)
    if (step(world).sleeping_bodies == bodies) return true;
  return false;
}

inline bool are_same(const Records& a, const Records& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0;
}

inline bool has_same_poses(const State& a, const State& b) {
  return are_same(a.positions, b.positions) && are_same(a.remainders, b.remainders) &&
         are_same(a.velocities, b.velocities) && are_same(a.frames.orientations, b.frames.orientations) &&
         are_same(a.frames.angular_velocities, b.frames.angular_velocities) &&
         are_same(a.frames.inverse_inertias, b.frames.inverse_inertias);
}

}  // namespace pliant::testing_support
