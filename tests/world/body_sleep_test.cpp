// Tests sleep of rigid bodies: what sleeps does not move by a bit, and what acts on it wakes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "world/body_sleep_support.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(BodySleep, IsOffByDefault) {
  Scene scene;
  scene.add(ground());
  scene.add(light_pyramid(3));
  World world(scene);
  for (int frame = 0; frame < four_seconds; ++frame) EXPECT_EQ(step(world).sleeping_bodies, 0);
  EXPECT_TRUE(world.state().rest_times.empty());
  EXPECT_FALSE(world.object(0).body_is_asleep(0));
  EXPECT_THROW((void)world.object(0).body_is_asleep(6), Error);
}

/// No contact is solved, and no bit of a pose or contact changes.
TEST(BodySleep, APileHasTheSameBitsForAThousandFrames) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(light_pyramid(6));
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, 21));
  const State before = world.state();
  EXPECT_FALSE(before.body_contacts.empty());
  for (int frame = 0; frame < 1000; ++frame) {
    const Report report = step(world);
    ASSERT_EQ(report.sleeping_bodies, 21);
    ASSERT_EQ(report.contacts, 0);
    ASSERT_TRUE(has_same_poses(world.state(), before)) << "frame " << frame;
    ASSERT_EQ(world.state().body_contacts.size(), before.body_contacts.size());
    ASSERT_EQ(std::memcmp(world.state().body_contacts.data(), before.body_contacts.data(),
                          before.body_contacts.size() * sizeof(BodyContact)),
              0);
  }
  EXPECT_TRUE(world.object(0).body_is_asleep(20));
}

/// Awake for as long as the thresholds say, and no longer.
TEST(BodySleep, WaitsForItsTime) {
  Scene scene = sleeping_scene();
  scene.settings.sleep.time = 1;
  scene.gravity = {};
  Object boxes;
  add_colliding_body(boxes, Box{{.5f, .5f, .5f}}, {0, 0, 0});
  add_colliding_body(boxes, Box{{.5f, .5f, .5f}}, {5, 0, 0}, {0.03f, 0, 0});  // faster than 0.02 m/s
  scene.add(boxes);
  World world(scene);
  for (int frame = 1; frame <= 120; ++frame) {
    step(world);
    const bool is_near = frame >= 59 && frame <= 61;  // rounding of the sum
    EXPECT_TRUE(is_near || world.object(0).body_is_asleep(0) == (frame > 60)) << "frame " << frame;
    EXPECT_FALSE(world.object(0).body_is_asleep(1));
  }
}

/// An object that is far from everything and only keeps a body awake would wake others by no rule.
TEST(BodySleep, ABodyThatMovesElsewhereWakesNothing) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(light_pyramid(3));
  Object slider;
  slider.static_friction = slider.kinetic_friction = 0;
  add_colliding_body(slider, Box{{.5f, .5f, .5f}}, {0, 0.5f, 20}, {1, 0, 0});
  scene.add(slider);
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, 6));
  for (int frame = 0; frame < 60; ++frame) EXPECT_EQ(step(world).sleeping_bodies, 6);
}

/// Piles that fall asleep at different times, and a ball that wakes one.
Scene busy_scene(int threads) {
  Scene scene = sleeping_scene();
  scene.settings.threads = threads;
  scene.add(ground());
  scene.add(light_pyramid(4));
  scene.add(single_box());
  Object ball;
  add_colliding_body(ball, Sphere{.4f}, {-12, 0.4f, 0}, {6, 0, 0});
  scene.add(ball);
  return scene;
}

TEST(BodySleep, ARestoredWorldGoesOnWithTheSameBits) {
  World world(busy_scene(1));
  std::vector<State> states;
  std::vector<std::string> hashes;
  for (int frame = 0; frame < four_seconds; ++frame) {
    states.push_back(world.state());
    step(world);
    hashes.push_back(world.state_hash());
  }
  int falls = 0, wakes = 0;
  World other(busy_scene(1));
  for (std::size_t frame = 1; frame + 1 < states.size(); ++frame) {
    const auto sleepers = [&](const State& state) {
      return std::count(state.rest_times.begin(), state.rest_times.end(), asleep);
    };
    const auto change = sleepers(states[frame]) - sleepers(states[frame - 1]);
    falls += change > 0 ? 1 : 0;
    wakes += change < 0 ? 1 : 0;
    if (change == 0 && frame % 40 != 0) continue;
    for (std::size_t from = frame - 1; from <= frame; ++from) {  // across the change
      other.restore(states[from]);
      step(other);
      EXPECT_EQ(other.state_hash(), hashes[from]) << "frame " << from;
      step(other);
      EXPECT_EQ(other.state_hash(), hashes[from + 1]) << "frame " << from;
    }
  }
  EXPECT_GT(falls, 1);
  EXPECT_GT(wakes, 0);
}

TEST(BodySleep, HasTheSameBitsOnAnyNumberOfThreads) {
  std::string hashes[2];
  for (int i = 0; i < 2; ++i) {
    World world(busy_scene(i + 1));
    for (int frame = 0; frame < four_seconds; ++frame) step(world);
    hashes[i] = world.state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

/// Cloth with other substeps, which nothing touches, makes groups of several solvers. Each gets the bits that it gets
/// alone.
TEST(BodySleep, HasTheSameBitsBesideOtherGroups) {
  Scene beside = busy_scene(1);
  Object cloth = make_cloth(grid_mesh(9, 9, 1, 1));
  for (Vec3f& p : cloth.positions) p.y += 20;
  cloth.pins = {{0, {}}, {8, {}}};
  beside.add(cloth);
  World alone(busy_scene(1)), other(beside);
  int most = 0;
  for (int frame = 0; frame < four_seconds; ++frame) {
    const int sleeping = step(alone).sleeping_bodies;
    ASSERT_EQ(step(other).sleeping_bodies, sleeping) << "frame " << frame;
    most = std::max(most, sleeping);
    for (int o = 0; o < 3; ++o) {
      const std::vector<Vec3f> a = alone.object(o).positions(), b = other.object(o).positions();
      ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)), 0) << "object " << o << ", frame " << frame;
    }
  }
  EXPECT_GT(most, 5);
}

TEST(BodySleep, RefusesThresholdsWithoutMeaning) {
  for (const SleepOptions& wrong :
       {SleepOptions{true, 0}, SleepOptions{true, 0.02f, -1}, SleepOptions{true, 0.02f, 0.04f, -1}}) {
    Scene scene;
    scene.add(single_box());
    scene.settings.sleep = wrong;
    EXPECT_THROW(World{scene}, Error);
  }
}

/// A contact of bodies that sleep goes on, so it does not end and begin as an event.
TEST(BodySleep, ContactEventsPersist) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(single_box());
  World world(scene);
  world.record_contact_events(true);
  ASSERT_TRUE(fall_asleep(world, 1));
  for (int frame = 0; frame < 5; ++frame) {
    step(world);
    ASSERT_EQ(world.contact_events().size(), 1U);
    EXPECT_EQ(world.contact_events()[0].change, ContactEvent::Change::persist);
  }
}

}  // namespace
}  // namespace pliant
