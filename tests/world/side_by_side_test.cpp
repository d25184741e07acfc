// Tests sets of objects that run side by side within a frame: bits, reports, requests to stop, and failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "world/substep_groups_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet whose substeps follow the State, and which can meet no other object: it is a set of its own.
Object member(int i) {
  Object cloth =
      sheet("cloth " + std::to_string(i), {0, 0.1f * static_cast<float>(i % 2), 1.5f * static_cast<float>(i)}, 21);
  cloth.self_collision = i % 3 == 0;
  if (i % 3 != 1) cloth.pins.resize(1);
  if (i % 3 == 2) cloth.pins.clear();
  return cloth;
}

/// Sheets that hang, fall on balls, or fold onto themselves. One ball moves and meets two of them.
Scene crowd(const std::vector<int>& members, int threads) {
  Scene scene;
  for (const int i : members) scene.add(member(i));
  for (int i = 0; i < 6; ++i) {
    Collider ball;
    ball.shape = Sphere{0.2f};
    ball.position = {0.05f, -0.4f, 1.5f * static_cast<float>(i)};
    if (i == 2) ball.motion = straight({0, 0, 1.5f}, 1);
    scene.add(ball);
  }
  scene.wind.velocity = {1, 0, 0.5f};
  scene.wind.air_density = 1.2f;
  scene.settings.threads = threads;
  return scene;
}

const std::vector<int> all_objects{0, 1, 2, 3, 4, 5};

TEST(SideBySide, GetTheBitsThatEachGetsAloneOnAnyThreads) {
  std::vector<World> alone;
  for (const int i : all_objects) alone.emplace_back(crowd({i}, 1));
  for (const int threads : {1, 2, 3, 8}) {
    World world(crowd(all_objects, threads));
    int fewest = 1000, most = 0;
    for (int frame = 0; frame < 30; ++frame) {
      world.step(dt);
      for (const int i : all_objects) {
        const float own = world.state().substeps[static_cast<std::size_t>(i)];
        fewest = std::min(fewest, static_cast<int>(own));
        most = std::max(most, static_cast<int>(own));
      }
    }
    EXPECT_GT(most, 2 * fewest) << "or all have the same substeps, and this shows little";
    for (const int i : all_objects) {
      if (threads == 1)
        for (int frame = 0; frame < 30; ++frame) alone[static_cast<std::size_t>(i)].step(dt);
      SCOPED_TRACE(std::to_string(threads) + " threads, cloth " + std::to_string(i));
      expect_the_same(world, i, alone[static_cast<std::size_t>(i)], 0);
    }
  }
}

TEST(SideBySide, AddUpInTheReport) {
  World world(crowd(all_objects, 2));
  std::vector<World> alone;
  for (const int i : all_objects) alone.emplace_back(crowd({i}, 1));
  std::int64_t touching = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const Report report = world.step(dt);
    Report sum;
    for (World& one : alone) {
      const Report own = one.step(dt);
      sum.contacts += own.contacts;
      sum.pairs.contacts += own.pairs.contacts;
      sum.substeps = std::max(sum.substeps, own.substeps);
      sum.iterations.largest = std::max(sum.iterations.largest, own.iterations.largest);
    }
    ASSERT_EQ(report.contacts, sum.contacts);
    ASSERT_EQ(report.pairs.contacts, sum.pairs.contacts);
    ASSERT_EQ(report.substeps, sum.substeps);
    ASSERT_EQ(report.iterations.smallest, 1);
    ASSERT_EQ(report.iterations.largest, sum.iterations.largest);
    touching += report.contacts;
  }
  EXPECT_GT(touching, 0) << "or this shows nothing";
}

/// A field that all threads may call asks to stop in the middle of a frame. All sets stop at the same time, a quarter's
/// end.
TEST(SideBySide, StopTogetherAtAQuarter) {
  for (const int threads : {1, 4}) {
    std::atomic<bool> stop{false};
    std::atomic<float> at{std::numeric_limits<float>::infinity()};
    Scene scene = crowd(all_objects, threads);
    ForceField field([&](const Vec3f&, const Vec3f&, float, float time) {
      if (time >= at) stop = true;
      return Vec3f{};
    });
    field.on_all_threads = true;
    scene.forces.push_back(field);
    World world(scene), undisturbed(scene);
    for (int frame = 0; frame < 20; ++frame) world.step(dt), undisturbed.step(dt);
    const State before = world.state();
    at = static_cast<float>(before.time + 0.4 * double(dt));
    world.stop_when(&stop);
    const Report report = world.step(dt);
    EXPECT_TRUE(report.stopped);
    const double quarter = (world.state().time - before.time) / (0.25 * double(dt));
    EXPECT_NEAR(quarter, 2, 1e-6) << "the end of the quarter in which the request came";
    EXPECT_GT(report.contacts, 0);
    EXPECT_EQ(world.state().frame, before.frame);
    at = std::numeric_limits<float>::infinity();
    stop = false;
    world.restore(before);
    world.step(dt);
    undisturbed.step(dt);
    EXPECT_EQ(world.state_hash(), undisturbed.state_hash()) << "the frame made again";
  }
}

/// Two sets get velocities that are not finite: the first in the order of objects is named, and the State is finite.
TEST(SideBySide, NameTheFirstThatFails) {
  for (const int threads : {1, 4}) {
    World world(crowd(all_objects, threads));
    for (int frame = 0; frame < 5; ++frame) world.step(dt);
    for (const int i : {4, 2}) {
      std::vector<Vec3f> velocities = world.object(i).velocities();
      velocities[7] = {3e38f, 3e38f, 0};
      world.object(i).set_velocities(velocities);
    }
    const Report report = world.step(dt);
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.nonfinite->object, "cloth 2");
    for (const int i : all_objects)
      for (const Vec3f& p : world.object(i).positions()) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << i;
  }
}

}  // namespace
}  // namespace pliant
