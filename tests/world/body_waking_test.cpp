// Tests what wakes bodies that sleep: the user, what comes, joints, and supports that go.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "world/body_sleep_support.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The box sleeps; then something happens, and it is awake within the given number of steps.
void expect_waking(World& world, const std::string& what, const std::function<void()>& act, int steps = 1) {
  ASSERT_TRUE(fall_asleep(world, 1)) << what;
  act();
  for (int i = 0; i < steps; ++i) step(world);
  EXPECT_FALSE(world.object(0).body_is_asleep(0)) << what;
}

TEST(BodySleep, WhatTheUserSetsWakes) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(single_box());
  const std::vector<Vec3f> up{{0, 1, 0}}, nothing{{0, 0, 0}};
  Object ball;
  add_colliding_body(ball, Sphere{.1f}, {10, 5, 0});
  const std::vector<std::pair<std::string, std::function<void(World&)>>> ways{
      {"velocities", [&](World& world) { world.object(0).set_velocities(up); }},
      {"impulses", [&](World& world) { world.object(0).add_impulses(nothing); }},
      {"forces", [&](World& world) { world.object(0).set_forces(up); }},
      {"addition", [&](World& world) { world.add(ball); }},
      {"edit",
       [&](World& world) {
         world.edit(0, {single_box(), {0}});
       }},
      {"velocities in the State",
       [&](World& world) {
         State state = world.state();
         state.velocities[0].y = 1;
         world.restore(state);
       }},
      {"times of rest in the State",
       [&](World& world) {
         State state = world.state();
         state.rest_times.clear();
         world.restore(state);
       }},
      {"pose of the ground",
       [&](World& world) {
         world.collider(0).set_pose({{0, 0.01f, 0}, {}});
       }},
  };
  for (const auto& [what, act] : ways) {
    World world(scene);
    expect_waking(world, what, [&, &way = act] { way(world); });
  }
}

TEST(BodySleep, AForceFieldKeepsBodiesAwake) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(single_box());
  scene.forces.emplace_back([](const Vec3f&, const Vec3f&, float, float) { return Vec3f{}; });
  World world(scene);
  EXPECT_FALSE(fall_asleep(world, 1));
}

/// A ball rolls against a box that sleeps: it passes its momentum on as to a box that is awake, because the box wakes
/// before the contact is solved.
TEST(BodySleep, ABallWakesWhatItHits) {
  float after[2] = {};
  for (const bool sleeps : {false, true}) {
    Scene scene = sleeping_scene();
    scene.settings.sleep.on = sleeps;
    scene.gravity = {};
    Object box;
    add_colliding_body(box, Box{{.5f, .5f, .5f}}, {});
    scene.add(box);
    Object ball;
    add_colliding_body(ball, Sphere{.2f}, {-5.7f, 0, 0}, {5, 0, 0});
    scene.add(ball);
    World world(scene);
    bool was_asleep = false;
    for (int frame = 0; frame < 120; ++frame) {
      step(world);
      was_asleep = was_asleep || world.object(0).body_is_asleep(0);
    }
    EXPECT_EQ(was_asleep, sleeps);
    after[sleeps ? 1 : 0] = world.object(0).velocities()[0].x;
  }
  EXPECT_NEAR(after[0], 2.5f, 0.01f) << "two equal masses, no restitution";
  EXPECT_NEAR(after[1], after[0], 1e-4f);
}

TEST(BodySleep, ClothThatFallsOnABoxWakesIt) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(single_box());
  Object cloth = make_cloth(grid_mesh(9, 9, 1, 1));
  for (Vec3f& p : cloth.positions) p = {p.x - 0.5f, 8, p.z + 1.5f};
  cloth.collides = true;
  cloth.thickness = 0.02f;
  scene.add(cloth);
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, 1));
  int frame = 0;
  while (frame < 180 && world.object(0).body_is_asleep(0)) step(world), ++frame;
  EXPECT_FALSE(world.object(0).body_is_asleep(0));
  float lowest = 8;
  for (const Vec3f& p : world.object(1).positions()) lowest = std::min(lowest, p.y);
  EXPECT_NEAR(lowest, 1, 0.2f) << "when it touches, not before";
}

/// A pusher comes by keyframes and moves the box by 0.3 m.
TEST(BodySleep, AColliderThatComesWakes) {
  Scene scene = sleeping_scene();
  scene.add(ground());
  scene.add(single_box());
  Collider pusher;
  pusher.shape = Box{{.1f, .4f, .4f}};
  pusher.position = {-3, 0.5f, 2};
  pusher.motion.keyframes = {{3, {}}, {4, {2.7f, 0, 0}}};
  scene.add(pusher);
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, 1));
  for (int frame = 0; frame < 300; ++frame) step(world);
  EXPECT_GT(world.object(0).positions()[0].x, 0.29f);
}

/// Of two bodies that a hinge connects one gets a velocity: both wake. A new target of the motor wakes both, too.
TEST(BodySleep, JointsAndMotorsWake) {
  Scene scene = sleeping_scene();
  scene.gravity = {};
  Object arms;
  add_colliding_body(arms, Box{{.5f, .1f, .1f}}, {0, 0, 0});
  add_colliding_body(arms, Box{{.5f, .1f, .1f}}, {1.2f, 0, 0});
  HingeJoint hinge;
  hinge.options.name = "hinge";
  hinge.a = 0;
  hinge.b = 1;
  hinge.anchor = {0.6f, 0, 0};
  hinge.axis = {0, 0, 1};
  hinge.motor = JointMotor{JointMotor::Kind::speed, 0, 10};
  add_joint(arms, hinge);
  scene.add(arms);
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, 2));
  const State before = world.state();
  for (int frame = 0; frame < 10; ++frame) step(world);
  EXPECT_TRUE(has_same_poses(world.state(), before));
  State pushed = world.state();
  pushed.velocities[0].y = 0.5f;
  world.restore(pushed);
  step(world);
  EXPECT_FALSE(world.object(0).body_is_asleep(0) || world.object(0).body_is_asleep(1));
  world.restore(before);
  step(world);
  ASSERT_TRUE(world.object(0).body_is_asleep(1));
  world.object(0).set_motor("hinge", {.target = 1});
  for (int frame = 0; frame < 30; ++frame) step(world);
  const std::vector<Vec3f> spin = world.object(0).angular_velocities();
  EXPECT_NEAR(spin[1].z - spin[0].z, 1, 0.01);
}

/// A platform of infinite mass that set_targets lifts takes a sleeping box of another object along.
TEST(BodySleep, AFixedBodyThatIsMovedByTargetsWakes) {
  Scene scene = sleeping_scene();
  Object platform;
  BodyOptions fixed;
  fixed.mass = std::numeric_limits<float>::infinity();
  add_body(platform, {{Box{{1, 0.1f, 1}}}}, fixed);
  scene.add(platform);
  Object box;
  add_colliding_body(box, Box{{.3f, .3f, .3f}}, {0, 0.4f, 0});
  scene.add(box);
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) step(world);
  ASSERT_TRUE(world.object(1).body_is_asleep(0));
  const int centre = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    const Vec3f target{0, 0.01f * static_cast<float>(frame), 0};
    world.object(0).set_targets(std::span(&centre, 1), std::span(&target, 1));
    step(world);
  }
  EXPECT_NEAR(world.object(1).positions()[0].y, 1, 0.02);
}

/// Bodies that particles are tied to stay awake.
TEST(BodySleep, ABodyOnARopeStaysAwake) {
  Scene scene = sleeping_scene();
  Object object;
  add_colliding_body(object, Box{{.1f, .1f, .1f}}, {0, -1.1f, 0});
  const int first = append(object, make_rope({{0, 0, 0}, {0, -0.5f, 0}, {0, -1, 0}}));
  object.pins.push_back({first, {}});
  attach(object, {first + 2}, 0);
  scene.add(object);
  World world(scene);
  EXPECT_FALSE(fall_asleep(world, 1));
}

/// Three boxes on a plate: where the plate goes, they fall.
TEST(BodySleep, AStackWhoseSupportGoesFalls) {
  Object stack;
  for (int i = 0; i < 3; ++i) add_colliding_body(stack, Box{{.5f, .5f, .5f}}, {0, 0.5f + static_cast<float>(i), 0});
  const Box plate{{1, .1f, 1}};
  Collider collider;
  collider.shape = plate;
  collider.position = {0, -0.1f, 0};
  Object fixed;
  BodyOptions options;
  options.position = collider.position;
  options.mass = std::numeric_limits<float>::infinity();
  fixed.collides = true;
  add_body(fixed, {{plate}}, options);
  const auto falls = [&](bool is_collider, const std::function<void(World&)>& pull) {
    Scene scene = sleeping_scene();
    scene.add(stack);
    is_collider ? scene.add(collider) : scene.add(fixed);
    World world(scene);
    EXPECT_TRUE(fall_asleep(world, 3));
    pull(world);
    for (int frame = 0; frame < 60; ++frame) step(world);
    return world.object(0).positions()[0].y < -3;
  };
  EXPECT_TRUE(falls(true, [](World& world) { world.remove(ColliderId(0)); }));
  EXPECT_TRUE(falls(true, [](World& world) { world.collider(0).set_pose({{0, -20, 0}, {}}); }));
  EXPECT_TRUE(falls(false, [](World& world) { world.remove(ObjectId(1)); }));
}

/// A row of dominoes sleeps when a ball comes.
TEST(BodySleep, ABallSetsOffDominoesThatSleep) {
  constexpr int count = 12;
  Scene scene = sleeping_scene();
  scene.add(ground());
  Object dominoes;
  dominoes.static_friction = dominoes.kinetic_friction = 0.6f;
  for (int i = 0; i < count; ++i)
    add_colliding_body(dominoes, Box{{.04f, .4f, .2f}}, {0.4f * static_cast<float>(i), 0.4f, 0});
  scene.add(dominoes);
  Object ball;
  ball.static_friction = ball.kinetic_friction = 0;
  add_colliding_body(ball, Sphere{.3f}, {-6, 0.3f, 0}, {3, 0, 0});
  scene.add(ball);
  World world(scene);
  ASSERT_TRUE(fall_asleep(world, count));
  for (int frame = 0; frame < 2 * four_seconds; ++frame) step(world);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_LT(p.y, 0.35f) << "it has fallen";
}

}  // namespace
}  // namespace pliant
