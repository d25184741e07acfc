// Tracers: how many there are, where, and that gases carry them along.
#include <gtest/gtest.h>

#include <algorithm>

#include "pliant/gas.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::frame_time;

Scene stream(const Vec3f& velocity, const Tracers& tracers, int capacity) {
  Scene scene;
  GasOptions gas;
  gas.velocity = velocity;
  scene.add(make_gas(fill_box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, gas.fluid.spacing), gas));
  scene.add(make_tracers({.tracers = tracers, .capacity = capacity}));
  scene.settings.threads = 1;
  return scene;
}

std::int64_t there(const World& world) {
  const std::vector<float> ages = world.object(1).channel("age");
  return std::count_if(ages.begin(), ages.end(), [](float age) { return age >= 0; });
}

TEST(Tracers, AreEmittedAtTheirRateAndVanish) {
  World world(stream({}, {.source = {.radius = 0.1f}, .rate = 600, .lifetime = 0.5f, .start = 0.1f, .end = 1}, 1000));
  EXPECT_EQ(there(world), 0);
  for (int i = 0; i < 24; ++i) world.step(frame_time);
  EXPECT_NEAR(static_cast<double>(there(world)), 600 * 0.3, 1);
  for (int i = 0; i < 24; ++i) world.step(frame_time);
  EXPECT_NEAR(static_cast<double>(there(world)), 600 * 0.5, 4);
  for (int i = 0; i < 60; ++i) world.step(frame_time);
  EXPECT_EQ(there(world), 0);
}

TEST(Tracers, AreAtMostAsManyAsTheCapacity) {
  World world(stream({}, {.source = {.radius = 0.1f}, .rate = 600, .lifetime = 10}, 50));
  for (int i = 0; i < 24; ++i) world.step(frame_time);
  EXPECT_EQ(there(world), 50);
}

TEST(Tracers, StartInTheirRegion) {
  for (const bool is_ball : {true, false}) {
    Tracers tracers{.source = {.centre = {0.1f, 0, 0}, .half_size = {0.1f, 0.2f, 0.05f}}, .rate = 6000, .lifetime = 9};
    if (is_ball) tracers.source.radius = 0.1f;
    World world(stream({}, tracers, 1000));
    for (int i = 0; i < 10; ++i) world.step(frame_time);
    Vec3f low{9, 9, 9}, high{-9, -9, -9};
    for (const Vec3f& p : world.object(1).positions()) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    EXPECT_NEAR(low.y, is_ball ? -0.1 : -0.2, 0.02);
    EXPECT_NEAR(high.y, is_ball ? 0.1 : 0.2, 0.02);
    EXPECT_NEAR(low.x, 0, 0.02);
    EXPECT_NEAR(high.x, 0.2, 0.02);
  }
}

TEST(Tracers, GoWithTheGas) {
  World world(stream({0.5f, 0.2f, 0}, {.source = {.radius = 0.1f}, .rate = 6000, .lifetime = 10, .end = 0.05f}, 1000));
  for (int i = 0; i < 63; ++i) world.step(frame_time);
  const std::vector<float> ages = world.object(1).channel("age");
  const std::vector<Vec3f> places = world.object(1).positions();
  Vec3f mean{};
  float count = 0;
  for (std::size_t i = 0; i < ages.size(); ++i)
    if (ages[i] >= 0) mean += places[i], ++count;
  EXPECT_NEAR(mean.x / count, 0.5 * 1.025, 0.02);
  EXPECT_NEAR(mean.y / count, 0.2 * 1.025, 0.02);
}

}  // namespace
}  // namespace pliant
