// Grains that sleep: they stay where they are, cost no projection, and wake when something near moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "grains/grain_support.h"
#include "pliant/body.h"
#include "pliant/cluster.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::grain_diameter;
using testing_support::grain_radius;
using testing_support::run;

Collider ground() {
  Collider plane;
  plane.static_friction = plane.kinetic_friction = 1;
  return plane;
}

/// A block of 5 x 6 x 5 grains a little above the ground.
Scene heap(bool sleeps) {
  std::vector<Vec3f> places = fill_box({0, 0, 0}, {5.4f * grain_diameter, 6.4f * grain_diameter, 5.4f * grain_diameter},
                                       1.05f * grain_diameter);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto part = [&](std::size_t prime) {
      return 0.05f * grain_diameter * static_cast<float>(i * prime % 101) / 101;
    };
    places[i] = places[i] + Vec3f{part(37), part(59), part(83)};
  }
  Scene scene;
  scene.add(make_grains(places, {.grains = {.radius = grain_radius}}));
  scene.add(ground());
  scene.settings.sleep.on = sleeps;
  scene.settings.threads = 1;
  return scene;
}

/// A box that lies still; balls roll in the hollows between grains for long.
Object box(const Vec3f& position) {
  BodyOptions options;
  options.position = position;
  Object object = make_body({{.shape = Box{{0.04f, 0.04f, 0.04f}}, .density = 1000}}, options);
  object.name = "box";
  return object;
}

Object ball(const Vec3f& position, const Vec3f& velocity) {
  BodyOptions options;
  options.position = position;
  options.velocity = velocity;
  options.angular_velocity = {0, 0, -velocity.x / 0.04f};  // it rolls
  Object object = make_body({{.shape = Sphere{0.04f}, .density = 3000}}, options);
  object.name = "ball";
  return object;
}

std::size_t sleepers(const World& world, int object = 0) {
  const std::vector<float> times = world.object(object).channel("rest_time");
  return static_cast<std::size_t>(std::count(times.begin(), times.end(), asleep));
}

TEST(SleepingGrains, StayWhereTheyAre) {
  World world(heap(true));
  run(world, 400);
  const std::size_t all = world.object(0).positions().size();
  EXPECT_EQ(sleepers(world), all);
  const std::vector<Vec3f> before = world.object(0).positions();
  const std::size_t contacts = world.state().grain_contacts.size();
  EXPECT_GT(contacts, all / 2);
  run(world, 60);
  EXPECT_EQ(world.object(0).positions(), before);
  EXPECT_EQ(world.state().grain_contacts.size(), contacts);
  EXPECT_EQ(world.step(1.f / 60).sleeping_grains, static_cast<int>(all));
}

TEST(SleepingGrains, AreOffByDefault) {
  World world(heap(false));
  run(world, 10);
  EXPECT_TRUE(world.object(0).channel("rest_time").empty());
}

/// The heap is as wide and as high as that of grains that do not sleep.
TEST(SleepingGrains, HaveTheHeapOfThoseThatDoNot) {
  World with(heap(true)), without(heap(false));
  run(with, 400);
  run(without, 400);
  const auto height = [](const World& world) {
    double sum = 0;
    for (const Vec3f& x : world.object(0).positions()) sum += static_cast<double>(x.y);
    return sum / static_cast<double>(world.object(0).positions().size());
  };
  EXPECT_NEAR(height(with), height(without), 0.05 * static_cast<double>(grain_diameter));
}

TEST(SleepingGrains, WakeUnderWhatFallsOnThem) {
  Scene scene = heap(true);
  World world(scene);
  run(world, 400);
  ASSERT_EQ(sleepers(world), world.object(0).positions().size());
  world.add(box({2.7f * grain_diameter, 0.4f, 2.7f * grain_diameter}));
  EXPECT_EQ(sleepers(world), 0u);  // what is added may lie on them
  run(world, 12);
  const std::vector<Vec3f> before = world.object(0).positions();
  run(world, 60);
  const std::vector<Vec3f> after = world.object(0).positions();
  float farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) farthest = std::max(farthest, length_squared(after[i] - before[i]));
  EXPECT_GT(farthest, grain_radius * grain_radius);
  run(world, 500);
  EXPECT_GT(sleepers(world), world.object(0).positions().size() * 9 / 10);
}

/// A ball that was there from the start, and arrives when all sleep.
TEST(SleepingGrains, WakeBeforeTheyAreHit) {
  Scene scene = heap(true);
  scene.add(ball({-24, 0.04f, 2.7f * grain_diameter}, {4, 0, 0}));
  World world(scene);
  run(world, 330);
  ASSERT_EQ(sleepers(world), world.object(0).positions().size());
  const std::vector<Vec3f> before = world.object(0).positions();
  run(world, 90);
  const std::vector<Vec3f> after = world.object(0).positions();
  float farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) farthest = std::max(farthest, length_squared(after[i] - before[i]));
  EXPECT_GT(farthest, grain_diameter * grain_diameter);
}

TEST(SleepingGrains, FallWhenTheirGroundGoes) {
  World world(heap(true));
  run(world, 400);
  world.remove(ColliderId(0));
  EXPECT_EQ(sleepers(world), 0u);
  run(world, 30);
  for (const Vec3f& x : world.object(0).positions()) EXPECT_LT(x.y, -0.8f);
}

TEST(SleepingGrains, WakeWhenTheyAreTold) {
  World world(heap(true));
  run(world, 400);
  std::vector<Vec3f> impulses(world.object(0).positions().size());
  const float mass = 4.f / 3 * 3.14159265f * grain_radius * grain_radius * grain_radius * 2650;
  for (Vec3f& impulse : impulses) impulse = {0, 2 * mass, 0};
  world.object(0).add_impulses(impulses);
  for (const Vec3f& v : world.object(0).velocities()) EXPECT_NEAR(v.y, 2, 0.01);
}

/// A drain opens at the foot of a column, whose grains then fall into it one after another.
TEST(SleepingGrains, FallWhereADrainTakesOthers) {
  Scene scene = heap(true);
  scene.objects[0].flow.drains = {{.name = "sink",
                                   .shape = Box{{0.02f, 0.015f, 0.02f}},
                                   .position = {2.7f * grain_diameter, -1, 2.7f * grain_diameter}}};
  World world(scene);
  run(world, 400);
  ASSERT_EQ(sleepers(world), world.object(0).positions().size());
  Edit edit = unchanged(scene.objects[0]);
  edit.object.flow.drains[0].position = {2.7f * grain_diameter, 0.01f, 2.7f * grain_diameter};
  world.edit(ObjectId(0), edit);
  run(world, 300);
  EXPECT_EQ(world.object(0).present().size(), scene.objects[0].positions.size() - 6);
}

/// Grains that touch and go in the same step.
TEST(SleepingGrains, GoWhileTheySleep) {
  Scene scene = heap(true);
  scene.objects[0].flow.lifetime = 7;
  World world(scene);
  run(world, 400);
  ASSERT_EQ(sleepers(world), world.object(0).positions().size());
  run(world, 60);
  EXPECT_TRUE(world.object(0).present().empty());
  EXPECT_EQ(sleepers(world), 0u);
  for (const Record& x : world.state().positions) EXPECT_EQ(x.w, 0);
  EXPECT_NO_THROW(world.restore(State(world.state())));
}

TEST(SleepingGrains, WakeByAnEdit) {
  Scene scene = heap(true);
  World world(scene);
  run(world, 400);
  Edit edit = unchanged(scene.objects[0]);
  edit.object.grains->friction = 0.3f;
  world.edit(ObjectId(0), edit);
  EXPECT_EQ(sleepers(world), 0u);
  EXPECT_NO_THROW(world.restore(State(world.state())));
  run(world, 20);
  EXPECT_LT(world.state().grain_contacts.size(), 3 * scene.objects[0].positions.size());  // each once
}

/// A State whose first particles belong to no object.
TEST(SleepingGrains, AreRestoredBehindAGap) {
  Scene scene = heap(true);
  scene.objects.insert(scene.objects.begin(), ball({0, 1, 0}, {}));
  World world(scene);
  run(world, 30);
  world.remove(ObjectId(0));
  run(world, 400);
  EXPECT_GT(sleepers(world, 1), 0u);
  EXPECT_NO_THROW(world.restore(State(world.state())));
}

/// What a cluster holds together would be nailed to those that sleep.
TEST(SleepingGrains, AreNotOfClusters) {
  Scene scene = heap(true);
  add_clusters(scene.objects[0], 0.3f);
  World world(scene);
  run(world, 300);
  EXPECT_EQ(sleepers(world), 0u);
}

/// A platform that pins lower by 4 mm a second, slower than what counts as fast.
TEST(SleepingGrains, FollowASlowPlatform) {
  Scene scene = heap(true);
  BodyOptions options;
  options.position = {2.7f * grain_diameter, -0.05f, 2.7f * grain_diameter};
  options.mass = INFINITY;
  Object platform = make_body({{.shape = Box{{0.2f, 0.05f, 0.2f}}}}, options);
  platform.static_friction = platform.kinetic_friction = 1;
  Pin pin{0};
  pin.motion.keyframes = {{.time = 6}, {.time = 16, .position = {0, -0.04f, 0}}};
  platform.pins = {pin};
  scene.add(platform);
  scene.colliders.clear();
  World world(scene);
  run(world, 355);
  EXPECT_EQ(sleepers(world), world.object(0).positions().size());
  float highest = 0;
  for (const Vec3f& x : world.object(0).positions()) highest = std::max(highest, x.y);
  run(world, 600);
  float lowered = 0;
  for (const Vec3f& x : world.object(0).positions()) lowered = std::max(lowered, x.y);
  EXPECT_NEAR(lowered, highest - 0.04f, 0.002f);
}

TEST(SleepingGrains, DoNotFreezeInTheAir) {
  Scene scene = heap(true);
  scene.settings.sleep.time = 0;
  for (Vec3f& x : scene.objects[0].positions) x.y += 0.3f;
  World world(scene);
  run(world, 60);
  EXPECT_LT(world.object(0).positions()[0].y, 0.1f);
}

TEST(SleepingGrains, FollowFromTheState) {
  Scene scene = heap(true);
  World one(scene);
  scene.settings.threads = 3;
  World three(scene);
  run(one, 90);
  run(three, 90);
  EXPECT_EQ(hash(one.state()), hash(three.state()));
  const State awake = one.state();
  run(one, 160);
  ASSERT_GT(sleepers(one), 0u);
  const State kept = one.state();
  run(one, 60);
  World again(scene);
  again.restore(kept);
  run(again, 60);
  EXPECT_EQ(hash(again.state()), hash(one.state()));
  again.restore(awake);  // from before anything slept
  run(again, 160);
  EXPECT_EQ(hash(again.state()), hash(kept));
  State wrong = kept;
  const auto channel = std::find_if(wrong.channels.begin(), wrong.channels.end(),
                                    [](const Channel& of) { return of.name == "rest_time"; });
  ASSERT_NE(channel, wrong.channels.end());
  const std::vector<float>& times = channel->values;
  const auto sleeper = static_cast<std::size_t>(std::find(times.begin(), times.end(), asleep) - times.begin());
  wrong.positions[sleeper].w = 1;
  EXPECT_THROW(again.restore(wrong), Error);
}

}  // namespace
}  // namespace pliant
