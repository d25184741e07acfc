// Tests contact between surfaces beyond not crossing: which objects meet, where they rest, friction, and untangling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "math/vector.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ who meets whom

/// How far a sheet that falls on another, fixed one gets below it [m].
float sinks(const std::function<void(Object& held, Object& falling)>& change) {
  Scene scene = scene_of(10);
  Object held = cloth(sheet(10, 0.4f, 0)), falling = cloth(sheet(9, 0.2f, 0.02f));
  change(held, falling);
  const int object = scene.add(held);
  scene.add(falling);
  std::vector<int> all(100);
  for (int i = 0; i < 100; ++i) all[static_cast<std::size_t>(i)] = i;
  scene.pin(object, all);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  float lowest = 1;
  for (const Vec3f& p : world.object(1).positions()) lowest = std::min(lowest, p.y);
  return -lowest;
}

TEST(Groups, SayWhoMeetsWhom) {
  EXPECT_LT(sinks([](Object&, Object&) {}), 0.f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.collides = false; }), 0.5f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.groups = 2; }) + sinks([](Object& held, Object& falling) {
              held.groups = 2;
              falling.mask = 1;
            }),
            0.5f);
  EXPECT_GT(sinks([](Object&, Object& falling) { falling.mask = 2; }), 0.5f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.mask = 0; }), 0.5f);
  EXPECT_LT(sinks([](Object& held, Object& falling) {
              held.groups = 4;
              held.mask = 2;
              falling.groups = 2;
              falling.mask = 4;
            }),
            0.f);
}

// ------------------------------------------------------------------------------------------------ rest and friction

// Mesh neighbours keep at most nine tenths of their distance at rest, so a thickness of several edges must not push a
// mesh apart.
TEST(Thickness, OfMoreThanTheEdgesMovesNothing) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  scene.add(cloth(sheet(8, 0.35f, 0), 0.05f));
  World world(scene);
  const std::vector<Vec3f> start = world.object(0).positions();
  for (int frame = 0; frame < 5; ++frame) world.step(dt);
  const std::vector<Vec3f> end = world.object(0).positions();
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_LT(length_squared(end[i] - start[i]), 1e-10f) << i;
}

TEST(Layers, ComeToRestAtTheirThickness) {
  Scene scene = scene_of(10);
  for (int i = 0; i < 3; ++i) scene.add(cloth(sheet(8, 0.2f, 0.004f + 0.005f * static_cast<float>(i)), 0.002f));
  scene.add(floor_at(0));
  World world(scene);
  std::int64_t truncated = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const Report report = world.step(dt);
    if (frame < 60) continue;
    truncated += report.pairs.truncated;
    ASSERT_LT(world.measure().kinetic_energy(), 1e-6) << "frame " << frame;
  }
  EXPECT_LT(truncated, 60 * 10 * 192 / 100) << "steps at rest are not truncated";
  for (int i = 0; i < 3; ++i)
    for (const Vec3f& p : world.object(i).positions())
      EXPECT_NEAR(p.y, 0.002f + 0.004f * static_cast<float>(i), 2e-4f) << "layer " << i;
}

/// How far a patch of cloth slides in a second down two oblique triangles [m].
float slid(float degrees, float friction) {
  Scene scene = scene_of(10);
  const double angle = double(degrees) * 3.14159265358979 / 180;
  const auto turned = [&](const Vec3f& p) {
    const double c = std::cos(angle), s = std::sin(angle);
    return convert<float>(Vec3d{c * double(p.x) + s * double(p.y), c * double(p.y) - s * double(p.x), double(p.z)});
  };
  MeshCollider slope;
  slope.mesh = grid_mesh(2, 2, 8, 2);
  slope.static_friction = slope.kinetic_friction = friction;
  TriangleMesh patch = sheet(5, 0.2f, 0.002f);
  for (Vec3f& p : slope.mesh.positions) p = turned(p);
  for (Vec3f& p : patch.positions) p = turned(p);
  const Vec3f start = patch.positions[12];
  scene.add(slope);
  Object object = cloth(patch);
  object.static_friction = object.kinetic_friction = friction;
  scene.add(object);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  return length(world.object(0).positions()[12] - start);
}

TEST(Slope, HoldsClothBelowTheAngleOfFriction) {
  EXPECT_LT(slid(25.6f, 0.5f), 0.002f);  // tan 26.565 degrees is 0.5
  EXPECT_GT(slid(27.5f, 0.5f), 0.02f);
  const double angle = 40 * 3.14159265358979 / 180, expected = 0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
  EXPECT_NEAR(double(slid(40, 0.5f)), expected, 0.03 * expected);
}

// ------------------------------------------------------------------------------------------------ tangles

TEST(Tangle, IsCountedDoesNotExplodeAndIsForgottenOnceApart) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  std::vector<int> border;
  for (int i = 0; i < 100; ++i)
    if (i < 10 || i >= 90 || i % 10 == 0 || i % 10 == 9) border.push_back(i);
  scene.pin(scene.add(cloth(sheet(10, 0.4f, 0))), border);
  TriangleMesh upright = grid_mesh(9, 9, 0.31f, 0.31f);  // upright across the other one, its lower edge below it
  for (Vec3f& p : upright.positions) p = {p.x + 0.007f, p.z + 0.1f, 0.012f};
  Object object = cloth(upright);
  object.velocities.assign(object.positions.size(), Vec3f{0, 0.5f, 0});
  scene.add(object);
  World world(scene);
  Watch watch(world, scene);
  ASSERT_GT(watch.crossings(world), 5u);
  Report report = world.step(dt);
  EXPECT_GT(report.pairs.initially_intersecting, 5);
  for (int frame = 0; frame < 40; ++frame) {
    report = world.step(dt);
    ASSERT_TRUE(report.ok()) << report.explain();
    for (int o = 0; o < 2; ++o)
      for (const Vec3f& v : world.object(o).velocities()) ASSERT_LT(length(v), 3.f) << "frame " << frame;
  }
  EXPECT_EQ(watch.crossings(world), 0u);
  EXPECT_EQ(report.pairs.initially_intersecting, 0);
}

}  // namespace
}  // namespace pliant
