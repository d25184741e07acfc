// Tests stopping: a step that is asked to stop ends with the current substep, in a valid State.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A falling particle, in a frame of ten substeps. The force field, called once per substep, sets the flag in call
/// number `last`.
Scene falling(std::atomic<bool>& flag, int& asked, int last) {
  Scene scene;
  scene.settings = settings_of(10);
  scene.add(loose_particles({{0, 0, 0}}));
  scene.forces.push_back([&flag, &asked, last](const Vec3f&, const Vec3f&, float, float) {
    if (++asked == last) flag = true;
    return Vec3f{};
  });
  return scene;
}

TEST(Stop, EndsWithTheSubstepUnderWay) {
  std::atomic<bool> flag{false};
  int asked = 0;
  World world(falling(flag, asked, 3));
  world.stop_when(&flag);
  const Report report = world.step(0.1f);
  EXPECT_TRUE(report.stopped);
  EXPECT_TRUE(report.ok());
  EXPECT_EQ(asked, 3) << "substeps that were begun";
  EXPECT_EQ(world.state().frame, 0) << "the frame is not complete";
  EXPECT_NEAR(world.state().time, 0.03, 1e-9);
  EXPECT_EQ(report.time, world.state().time);
  EXPECT_NEAR(world.object(0).velocities()[0].y, -9.81f * 0.03f, 1e-6f) << "the velocity of that moment";
  EXPECT_NEAR(world.object(0).positions()[0].y, -9.81f * 0.01f * 0.01f * (1 + 2 + 3), 1e-6f);
}

TEST(Stop, LetsNothingMoveBeforeAStepAndGoesOnAfterIt) {
  std::atomic<bool> flag{true};
  World world(hanging_cloth()), other(hanging_cloth());
  const std::string before = world.state_hash();
  world.stop_when(&flag);
  EXPECT_TRUE(world.step(dt).stopped);
  EXPECT_EQ(world.state_hash(), before);
  flag = false;
  EXPECT_FALSE(world.step(dt).stopped);
  other.step(dt);
  EXPECT_EQ(world.state_hash(), other.state_hash());
  flag = true;
  world.stop_when(nullptr);
  EXPECT_FALSE(world.step(dt).stopped);
}

TEST(Stop, AFrameBrokenOffIsMadeAgainFromTheStateBeforeIt) {
  std::atomic<bool> flag{false};
  int asked = 0;
  const Scene scene = falling(flag, asked, 4);
  World world(scene), other(scene);
  const State before = world.state();
  world.stop_when(&flag);
  world.step(0.1f);
  world.stop_when(nullptr);
  world.restore(before);
  world.step(0.1f);
  other.step(0.1f);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

TEST(SeparatePhases, ShowWhatATileIsVisitedForAndChangeNoBit) {
  Scene scene = hanging_cloth();
  World world(scene);
  scene.settings.separate_phases = true;
  World apart(scene);
  for (int frame = 0; frame < 5; ++frame) {
    world.step(dt);
    const Report report = apart.step(dt);
    ASSERT_EQ(apart.state_hash(), world.state_hash());
    std::vector<std::string> names;
    for (const PhaseTime& phase : report.phases) names.push_back(phase.name);
    for (const char* name : {"predict", "solve: tiles", "update", "find non-finite values"})
      EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

TEST(SeparatePhases, ChangeNoBitWhereSurfacesMeet) {
  Scene scene = scene_of(8);
  scene.add(cloth(sheet(8, 0.5f, 0)));
  scene.add(cloth(sheet(10, 0.4f, 0.01f)));
  scene.pin(0, {0, 7, 56, 63});
  scene.settings.sweep = Sweep::tiled;
  World world(scene);
  scene.settings.separate_phases = true;
  World apart(scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < 10; ++frame) {
    contacts += world.step(dt).pairs.contacts;
    apart.step(dt);
    ASSERT_EQ(apart.state_hash(), world.state_hash()) << frame;
  }
  EXPECT_GT(contacts, 100);
}

}  // namespace
}  // namespace pliant
