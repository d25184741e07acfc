// Emitters, drains and lifetimes: what comes and goes is counted, is where it should be, and follows from the State
// alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "flow_support.h"
#include "pliant/edit.h"
#include "pliant/liquid.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Flow, EmitsTheVolumeOfFlowTimesTime) {
  Emitter emitter = nozzle(0);
  emitter.flow = 0.0123f;
  for (const bool is_disc : {false, true}) {
    if (is_disc) emitter.width = emitter.height = 0, emitter.radius = 3.2f * spacing;
    World world(jet(emitter));
    const FlowReport sum = run(world, 60);
    const auto held = static_cast<double>(2 * layer_of(emitter, jet(emitter).objects[0]).places.size());
    const double layer = held / 2 * std::pow(spacing, 3);
    EXPECT_NEAR((static_cast<double>(sum.emitted) - held) * std::pow(spacing, 3), 0.0123, layer);
    EXPECT_EQ(sum.emitted, living(world));
    EXPECT_EQ(sum.blocked + sum.refused + sum.drained + sum.expired, 0);
  }
}

TEST(Flow, HasTheFlowOfASpeedAndThePlacesOfALattice) {
  Emitter emitter = nozzle(2);
  const Scene scene = jet(emitter);
  const EmitterLayer layer = layer_of(emitter, scene.objects[0]);
  EXPECT_EQ(layer.places.size(), 25u);
  EXPECT_FLOAT_EQ(layer.speed, 2);
  EXPECT_FLOAT_EQ(layer.distance, spacing);
  EXPECT_NEAR(layer.flow, 2 * 0.01, 1e-6);
  emitter.width = emitter.height = 0, emitter.radius = 0.5f * spacing;
  EXPECT_EQ(layer_of(emitter, scene.objects[0]).places.size(), 1u);
  emitter.radius = 1.5f * spacing;
  EXPECT_EQ(layer_of(emitter, scene.objects[0]).places.size(), 5u);
}

/// Every particle is where its age says: x = x0 + v t + g t^2 / 2. A jet that does not spread keeps its lattice.
TEST(Flow, JetsFollowTheParabola) {
  Emitter emitter = nozzle(3);
  emitter.direction = {1, 0, 0};  // one that rises slows down, and so becomes thicker
  World world(jet(emitter));
  run(world, 30);
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  const std::vector<double> ages = world.object(0).ages();
  const double v = 3;
  double worst_speed = 0, worst_place = 0;
  double seen = 0;
  for (const int i : world.object(0).present()) {
    const auto p = static_cast<std::size_t>(i);
    const double t = ages[p];
    if (t < 0.1) continue;
    ++seen;
    worst_speed =
        std::max({worst_speed, std::abs(double(velocities[p].x) - v), std::abs(double(velocities[p].y) + 9.81 * t)});
    const double x = v * t, y = 1 - 9.81 * t * t / 2;
    worst_place = std::max(worst_place, std::hypot(double(places[p].x) - x, double(places[p].y) - y) - 2.5 * spacing);
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(worst_speed, 0.15) << "of 3 m/s";
  EXPECT_LT(worst_place, spacing);
}

/// Layers neither overlap nor gap: the nearest neighbour in a horizontal jet without gravity is a spacing away.
TEST(Flow, LayersFollowAtTheSpacingOfTheLiquid) {
  for (const float speed : {0.3f, 2.f, 8.f}) {
    Scene scene = jet(nozzle(speed));
    scene.gravity = {};
    World world(scene);
    run(world, 20);
    const std::vector<Vec3f> places = world.object(0).present_positions();
    ASSERT_GT(places.size(), 100u);
    for (const Vec3f& a : places) {
      float nearest = 1;
      for (const Vec3f& b : places)
        if (!(a == b)) nearest = std::min(nearest, std::sqrt(length_squared(a - b)));
      EXPECT_NEAR(nearest, spacing, 0.02f * spacing);
    }
  }
}

TEST(Flow, CountsEverythingThatComesAndGoes) {
  Drain drain;
  drain.shape = Box{{1, 0.1f, 1}};
  drain.position = {0, 0.3f, 0};
  World world(jet(nozzle(2), 3000, {drain}));
  const FlowReport sum = run(world, 90);
  EXPECT_GT(sum.drained, 1000);
  EXPECT_EQ(sum.emitted, sum.drained + living(world));
  EXPECT_EQ(sum.present, living(world));
  EXPECT_EQ(sum.refused + sum.blocked, 0) << "drained particles are used again";
  for (const Vec3f& p : world.object(0).present_positions()) EXPECT_GT(p.y, 0.1f);
}

TEST(Flow, ObeysTheCapacity) {
  World world(jet(nozzle(2), 130));
  const FlowReport sum = run(world, 30);
  EXPECT_EQ(sum.emitted, 130);
  EXPECT_EQ(living(world), 130);
  EXPECT_EQ(sum.emitted + sum.refused, 25 * 52) << "30 frames of 2 m/s are 50 layers, and the opening holds two";
}

TEST(Flow, EndsLives) {
  World world(jet(nozzle(2), 5000, {}, 0.25f));
  FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, sum.expired + living(world));
  EXPECT_NEAR(static_cast<double>(living(world)), 25 * 27, 2 * 25) << "a quarter of a second of 100 layers a second";
  for (const double age : world.object(0).ages()) EXPECT_LE(age, 0.25 + 1.01 / 60);
}

TEST(Flow, StartsAndEnds) {
  Emitter emitter = nozzle(2);
  emitter.start = 0.25f;
  emitter.end = 0.5f;
  World world(jet(emitter));
  EXPECT_EQ(run(world, 14).emitted, 0);
  EXPECT_EQ(run(world, 46).emitted, 25 * 25);
}

TEST(Flow, EmitsToTheEndWhateverTheStep) {
  Emitter emitter = nozzle(2);
  emitter.end = 0.3f;
  for (const float dt : {0.3f / 7, 1.f / 60, 0.004f}) {
    World world(jet(emitter));
    std::int64_t emitted = 0;
    while (world.state().time < 0.5) emitted += world.step(dt).flow.emitted;
    EXPECT_EQ(emitted, 30 * 25) << "100 layers a second, steps of " << dt;
  }
}

TEST(Flow, EndsWithTheNearestWholeLayer) {
  for (const auto& [end, layers] : {std::pair{0.1049f, 10}, std::pair{0.1051f, 11}, std::pair{0.0049f, 0}}) {
    Emitter emitter = nozzle(2);
    emitter.end = end;
    World world(jet(emitter));
    EXPECT_EQ(run(world, 30).emitted, layers * 25) << end;
  }
}

TEST(Flow, WhatFindsNoParticleIsRefusedAndNotBlocked) {
  Scene scene = jet(nozzle(0.5f), 60);
  scene.gravity = {};
  Collider lid;  // what it emits stays at the opening
  lid.position = {0, 1 - spacing, 0};
  scene.add(lid);
  World world(scene);
  const FlowReport sum = run(world, 120);
  EXPECT_EQ(sum.emitted, 60);
  EXPECT_GT(sum.refused, 0);
  const FlowReport full = run(world, 60);
  EXPECT_EQ(full.emitted + full.blocked, 0);
  EXPECT_EQ(full.refused, 25 * 25) << "a second of 25 layers, all of which lack particles";
}

TEST(Flow, AnEditedRateHoldsAtOnce) {
  for (const float speed : {0.5f, 4.f}) {
    World world(jet(nozzle(2)));
    run(world, 30);
    world.edit({0}, unchanged(jet(nozzle(speed)).objects[0]));
    const auto emitted = static_cast<double>(run(world, 30).emitted);
    EXPECT_NEAR(emitted / 25, speed / spacing / 2, 3);
  }
}

TEST(Flow, AnEditLeavesTheOpeningWhatItHolds) {
  const Scene scene = jet(nozzle(2));
  World world(scene), edited(scene);
  run(world, 30);
  run(edited, 30);
  edited.edit({0}, unchanged(scene.objects[0]));
  EXPECT_EQ(world.object(0).present(), edited.object(0).present());
  EXPECT_EQ(world.object(0).velocities(), edited.object(0).velocities());
  run(edited, 60);
  const std::vector<Vec3f> places = edited.object(0).positions(), speeds = edited.object(0).velocities();
  for (const int i : edited.object(0).present()) {
    const auto particle = static_cast<std::size_t>(i);
    if (places[particle].y > 0.9f) {
      EXPECT_NEAR(speeds[particle].y, -2, 0.8) << "it falls";
    }
  }
}

TEST(Flow, LeavesFixedParticlesWhereTheyAre) {
  Scene scene = jet(nozzle(2));
  scene.objects[0].positions.insert(scene.objects[0].positions.begin(), {0.5f, 0.5f, 0.5f});
  scene.objects[0].masses.insert(scene.objects[0].masses.begin(), std::numeric_limits<float>::infinity());
  World world(scene);
  run(world, 30);
  EXPECT_EQ(world.object(0).positions().front(), (Vec3f{0.5f, 0.5f, 0.5f}));
}

TEST(Flow, NeitherALifetimeNorADrainTakesFixedParticles) {
  Drain everywhere;
  everywhere.shape = Box{{9, 9, 9}};
  Scene scene = jet(nozzle(2), 20000, {everywhere}, 0.1f);
  scene.objects[0].positions.insert(scene.objects[0].positions.begin(), {0.5f, 0.5f, 0.5f});
  scene.objects[0].masses.insert(scene.objects[0].masses.begin(), std::numeric_limits<float>::infinity());
  World world(scene);
  EXPECT_GT(run(world, 30).drained, 0);
  const std::vector<int> present = world.object(0).present();
  ASSERT_FALSE(present.empty());
  EXPECT_EQ(present.front(), 0);
}

TEST(Flow, AMovingOpeningGivesItsVelocity) {
  Emitter emitter = nozzle(1);
  emitter.motion.keyframes = {{0, {0, 0, 0}, {}}, {1, {2, 0, 0}, {}}};
  Scene scene = jet(emitter);
  scene.gravity = {};
  World world(scene);
  run(world, 30);
  for (const int i : world.object(0).present()) {
    const Vec3f v = world.object(0).velocities()[static_cast<std::size_t>(i)];
    EXPECT_NEAR(v.x, 2, 0.02);
    EXPECT_NEAR(v.y, -1, 0.02);
  }
}

TEST(Flow, CountsWhatIsInItsWay) {
  Scene scene = jet(nozzle(0.5f), 5000);
  Object& liquid = scene.objects[0];
  const std::vector<Vec3f> plug = fill_box({-0.06f, 0.9f, -0.06f}, {0.06f, 1.2f, 0.06f}, spacing / 2);
  liquid.positions.insert(liquid.positions.begin(), plug.begin(), plug.end());
  liquid.masses.insert(liquid.masses.begin(), plug.size(), std::numeric_limits<float>::infinity());
  World world(scene);
  const FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, 0);
  EXPECT_NEAR(static_cast<double>(sum.blocked), 25 * (0.5 / 0.02 + 2), 25);
}

TEST(Flow, DoesNotEmitIntoWhatIsThere) {
  Scene scene = jet(nozzle(0.5f), 5000);
  Collider cup;
  cup.position = {0, 1 - spacing, 0};  // the nozzle is almost closed
  scene.add(cup);
  World world(scene);
  const FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, living(world));
  for (const Vec3f& v : world.object(0).velocities()) EXPECT_LT(std::sqrt(length_squared(v)), 5);
}

}  // namespace
}  // namespace pliant
