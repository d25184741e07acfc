// What the tests of substep groups share: a flag and a sock that never meet, in air over a floor.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "support/run.h"
#include "world/world_support.h"

namespace pliant::testing_support {

inline Object sheet(const std::string& name, const Vec3f& at, int n = 12) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-7f);
  Object cloth = sheet_at(name, at, n, 1, options);
  cloth.pins = {{0, {}}, {n - 1, {}}};
  cloth.thickness = 0.005f;
  cloth.drag = 1;
  return cloth;
}

/// A sheet solved by `multigrid`: in wind in 10 substeps.
inline Object flag() {
  Object object = sheet("flag", {0, 0.5f, 0});
  object.sweep = Sweep::multigrid;
  return object;
}

/// A self-colliding sheet, solved by `tiled` in 20 substeps. It lies in two layers, which fall on the floor.
inline Object sock() {
  Object object = sheet("sock", {0, -0.6f, 3}, 14);
  for (Vec3f& p : object.positions)
    if (p.z > 3) p = {p.x, p.y + 0.02f, 6 - p.z};
  object.pins = {{0, {}}};
  object.self_collision = true;
  object.sweep = Sweep::tiled;
  return object;
}

/// A scene with air, a ball that moves under the flag, and a floor on which the sock falls.
inline Scene scene_with_floor() {
  Scene scene;
  scene.wind.velocity = {1, 0, 2};
  scene.wind.gust = 0.5f;
  scene.wind.air_density = 1.2f;
  Collider ball, floor;
  ball.shape = Sphere{0.2f};
  ball.position = {-0.3f, 0.2f, 0};
  ball.motion = straight({1, 0, 0}, 1);
  floor.position = {0, -0.75f, 0};
  scene.add(ball);
  scene.add(floor);
  scene.settings.threads = 2;
  return scene;
}

inline Scene scene_of(const std::vector<Object>& objects) {
  Scene scene = scene_with_floor();
  for (const Object& object : objects) scene.add(object);
  return scene;
}

template <class T>
void expect_equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
}

inline constexpr int group_frames = 40;

/// Expects that object `o` of one World has the positions and velocities of object `other` of another World.
inline void expect_the_same(const World& world, ObjectId o, const World& alone, ObjectId other) {
  expect_equal_bits(world.object(o).positions(), alone.object(other).positions());
  expect_equal_bits(world.object(o).velocities(), alone.object(other).velocities());
  expect_equal_bits(world.object(o).orientations(), alone.object(other).orientations());
}

/// Simulates all of `sets` together, and expects that each set gets the bits that it gets alone.
inline void expect_each_set_as_alone(const std::vector<std::vector<Object>>& sets) {
  Scene scene = scene_with_floor();
  for (const std::vector<Object>& set : sets)
    for (const Object& object : set) scene.add(object);
  World together(scene);
  run(together, group_frames);
  int o = 0;
  for (const std::vector<Object>& set : sets) {
    World alone(scene_of(set));
    run(alone, group_frames);
    for (int i = 0; i < static_cast<int>(set.size()); ++i, ++o) {
      SCOPED_TRACE(set[static_cast<std::size_t>(i)].name);
      EXPECT_EQ(together.object(o).info().substeps, alone.object(i).info().substeps);
      expect_the_same(together, o, alone, i);
    }
  }
}

}  // namespace pliant::testing_support
