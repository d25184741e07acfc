// Tests what controls and stiffens objects: pins, targets, wind, PBD and compliance; and float precision with many
// substeps.
#include <gtest/gtest.h>

#include <cmath>

#include "support/nonfinite.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ control

TEST(Pins, DoNotMoveByABit) {
  World world(hanging_cloth());
  const Vec3f first = world.object(0).positions()[0], last = world.object(0).positions()[11];
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  EXPECT_EQ(world.object(0).positions()[0], first);
  EXPECT_EQ(world.object(0).positions()[11], last);
  EXPECT_LT(world.object(0).positions()[60].y, -0.05f);
}

TEST(Pins, FollowTheirKeyframes) {
  Motion motion{
      {Keyframe{0, {}, {}}, Keyframe{0.5f, {0.3f, 0.1f, 0}, rotation({0, 1, 0}, 90)}, Keyframe{1, {0, 0.5f, 0.2f}, {}}},
      {0.5f, 0, 0},
      false};
  Scene scene;
  scene.add(chain(10, 0.1f));
  scene.objects[0].pins.push_back({0, motion});
  World world(scene, settings_of(16));
  for (int frame = 1; frame <= 75; ++frame) {
    world.step(1.f / 64);
    const double time = frame / 64.0;
    // Relative to the pivot (0.5, 0, 0) the rest position is (-0.5, 0, 0). After a quarter turn about y it is at z =
    // +0.5.
    if (frame == 32) {
      EXPECT_LT(distance(world.object(0).positions()[0], {0.8f, 0.1f, 0.5f}), 1e-6);
    }
    if (time >= 1) {
      EXPECT_LT(distance(world.object(0).positions()[0], {0, 0.5f, 0.2f}), 1e-6) << frame;
    }
  }
}

TEST(Attachments, ConvergeToTheirTarget) {
  for (const bool moves : {false, true}) {
    Scene scene;
    scene.gravity = {};
    Object object = chain(2, 1);
    object.attachments.push_back(
        {0, {0, 0.4f, 0}, moves ? straight({0.5f, 0, 0}, 0.5f) : Motion{}, Stiffness::compliance(1e-4f)});
    object.damping = 5;
    scene.add(object);
    World world(scene, settings_of(20));
    for (int frame = 0; frame < 240; ++frame) world.step(dt);
    EXPECT_LT(distance(world.object(0).positions()[0], {moves ? 0.5f : 0, 0.4f, 0}), 2e-3) << moves;
  }
}

TEST(Attachments, HoldAWeightWithTheirCompliance) {
  Scene scene;
  Object object = loose_particles({{0, 0, 0}});
  object.attachments.push_back({0, {0, 0, 0}, {}, Stiffness::compliance(0.01f)});
  object.damping = 10;
  scene.add(object);
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 300; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].y, -0.0981, 1e-5);  // alpha m g
}

TEST(Wind, PushesAFlagAlongAndNotBeyondItsSpeed) {
  Scene scene;
  scene.gravity = {};
  scene.wind.velocity = {0, 3, 0};
  scene.wind.air_density = 1.2f;
  scene.add_cloth(grid_mesh(10, 10, 1, 1));
  World world(scene, settings_of(10));
  double before = 0;
  for (int frame = 0; frame < 240; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    double speed = 0;
    for (const Vec3f& v : world.object(0).velocities()) speed += v.y / 100.0;
    EXPECT_GE(speed, before - 1e-3) << frame;
    EXPECT_LE(speed, 3.001);
    before = speed;
  }
  EXPECT_GT(before, 2.5);
  scene.wind.air_density = 0;
  World still(scene, settings_of(10));
  still.step(dt);
  EXPECT_EQ(still.measure().kinetic_energy(), 0);
}

// ------------------------------------------------------------------------------------------------ stiffness

TEST(PbdStiffness, RemovesItsShareWhateverTheIterations) {
  for (Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::multigrid}) {
    for (float k : {0.1f, 0.5f, 0.9f, 1.f}) {
      for (int iterations : {1, 2, 5, 20, 200}) {
        Scene scene;
        scene.gravity = {};
        Object object = chain(2, 1, Stiffness::pbd(k));
        object.constraints[0].rest = {0.6f};
        scene.add(object);
        scene.settings = settings_of(1, iterations);
        scene.settings.sweep = sweep;
        World world(scene);
        world.step(dt);
        EXPECT_NEAR(distance(world.object(0).positions()[0], world.object(0).positions()[1]) - 0.6, (1 - k) * 0.4, 2e-6)
            << k << ", " << iterations << ", " << static_cast<int>(sweep);
      }
    }
  }
}

TEST(Compliance, IsBackwardEulerWhateverTheIterations) {
  // In every step of one mass on a spring from a fixed point: x = (m x~ + h^2 k l0) / (m + h^2 k).
  for (int iterations : {1, 2, 7, 50}) {
    Scene scene;
    scene.gravity = {};
    Object object = chain(2, 1, Stiffness::compliance(0.002f));
    object.constraints[0].rest = {0.8f};
    object.masses[0] = infinity;
    scene.add(object);
    World world(scene, settings_of(1, iterations));
    const double h = dt, k = 500, m = 1;
    double x = 1, v = 0;
    for (int frame = 0; frame < 30; ++frame) {
      world.step(dt);
      const double next = (m * (x + h * v) + h * h * k * 0.8) / (m + h * h * k);
      v = (next - x) / h;
      x = next;
      EXPECT_NEAR(world.object(0).positions()[1].x, x, 3e-6) << iterations << " iterations, frame " << frame;
    }
  }
}

TEST(Multipliers, StandInTheOrderOfTheGroups) {
  // A hanging chain, in which link i carries the weight of all below it. Its links are in two groups, and out of order.
  Scene scene;
  Object object = chain(7, 0.5f);
  for (Vec3f& p : object.positions) p = {0, -p.x, 0};
  object.masses[0] = infinity;
  object.constraints.clear();
  object.constraints.push_back({"distance", {3, 4, 0, 1}, {}, {}, {}});
  object.constraints.push_back({"distance", {5, 6, 2, 1, 4, 5}, {}, Stiffness::compliance(0, 1), {}});
  object.constraints.push_back({"distance", {2, 3}, {}, {}, {}});
  scene.add(object);
  Settings settings = settings_of(10, 30);
  settings.record_multipliers = true;
  World world(scene, settings);
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const std::vector<float> multipliers = world.object(0).multipliers("distance");
  const double h = dt / 10.0, below[] = {3, 6, 1, 5, 2, 4};
  ASSERT_EQ(multipliers.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(multipliers[i] / (h * h), -9.81 * below[i], 0.1) << "link " << i;
}

// ------------------------------------------------------------------------------------------------ floats and many substeps

TEST(Substeps, FreeFallIsTheDiscretePathInFloat) {
  for (int substeps : {1, 10, 100, 1000}) {
    Scene scene;
    scene.gravity = {0, -10, 0};
    scene.add(loose_particles({{0, 1, 0}}));
    World world(scene, settings_of(substeps));
    for (int frame = 0; frame < 30; ++frame) world.step(dt);
    const double h = static_cast<double>(dt) / substeps, n = 30.0 * substeps;
    const double fall = 10 * h * h * n * (n + 1) / 2;
    EXPECT_NEAR(1 - world.object(0).positions()[0].y, fall, 1e-4 * fall) << substeps;
  }
}

TEST(Substeps, AHangingSpringRestsAtTheSamePlace) {
  for (int substeps : {1, 10, 100, 1000}) {
    Scene scene;
    scene.gravity = {0, -10, 0};
    Object object = loose_particles({{0, 0, 0}, {0, -1.02f, 0}});
    object.masses[0] = infinity;
    object.constraints.push_back({"distance", {0, 1}, {1.f}, Stiffness::compliance(0.002f), {}});
    object.damping = 8;
    scene.add(object);
    World world(scene, settings_of(substeps));
    for (int frame = 0; frame < 120; ++frame) world.step(dt);
    EXPECT_NEAR(world.object(0).positions()[1].y, -1.02, 1e-4 * 0.02 + 2e-6) << substeps;
  }
}

}  // namespace
}  // namespace pliant
