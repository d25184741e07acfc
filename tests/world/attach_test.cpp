// Tests bodies that hang from ropes, and objects that are put together.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/joint.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

/// A box under a rope of 20 links that hangs from the origin.
Object hung_box(float mass) {
  BodyOptions options;
  options.position = {0, -1.1f, 0};
  options.mass = mass;
  Object object = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options);
  std::vector<Vec3f> points;
  for (int i = 0; i <= 20; ++i) points.push_back({0, -0.05f * static_cast<float>(i), 0});
  RopeOptions rope;
  rope.linear_density = 1;
  const int first = append(object, make_rope(points, rope));
  object.pins.push_back({first, {}});
  attach(object, {first + 20}, 0);
  return object;
}

TEST(Attach, ABoxHangsFromARopeAtItsLength) {
  Scene scene;
  scene.add(hung_box(1));
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const Vec3f at = world.object(0).positions()[0];
  EXPECT_NEAR(at.y, -1.1, 0.01);
  EXPECT_NEAR(std::hypot(at.x, at.z), 0, 1e-3);
}

/// The corner of the box is tied, so the box turns until its centre is below the rope's end.
TEST(Attach, ABoxTiedAtACornerTurns) {
  Object object = hung_box(1);
  object.constraints.pop_back();
  const int end = static_cast<int>(object.positions.size()) - 1;
  object.positions[0] += Vec3f{0.1f, 0, 0.1f};
  attach(object, {end}, 0);
  object.damping = 1;
  Scene scene;
  scene.add(object);
  World world(scene);
  for (int frame = 0; frame < 900; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const std::vector<Vec3f> at = world.object(0).positions();
  const Vec3f down = at[0] - at[static_cast<std::size_t>(end)];
  EXPECT_NEAR(std::sqrt(length_squared(down)), 0.1 * std::sqrt(3.), 2e-3);
  EXPECT_NEAR(-down.y, 0.1 * std::sqrt(3.), 5e-3);
}

TEST(Attach, OfWhatDoesNotExistIsNamed) {
  Object object = hung_box(1);
  try {
    attach(object, {0, 99}, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("particle 99"), std::string::npos) << error.what();
  }
}

TEST(Attach, OfNoParticlesIsRefused) {
  Object object = hung_box(1);
  object.name = "box";
  const std::string text = testing_support::refusal([&] { attach(object, {}, 0); });
  EXPECT_NE(text.find("object 'box', body 0: is tied to no particles"), std::string::npos) << text;
}

/// Names stay different, so that bodies and joints can be found by them.
TEST(Append, GivesTakenNamesANumber) {
  Object object = make_body({{Sphere{0.1f}}}, {.name = "ball"});
  add_joint(object, BallJoint{.b = 0, .options = {.name = "hook"}});
  Object all = object;
  append(all, object);
  append(all, object);
  std::vector<std::string> names;
  for (const ObjectBody& body : all.bodies) names.push_back(body.name);
  EXPECT_EQ(names, (std::vector<std::string>{"ball", "world", "ball_2", "world", "ball_3", "world"}));
  EXPECT_EQ(all.joints[1].name, "hook_2");
  EXPECT_EQ(all.joints[2].name, "hook_3");
  Scene scene;
  scene.add(all);
  const World world(scene);
  EXPECT_EQ(world.object(0).pose("ball_3").position, Vec3f{});
}

/// Two doors appended to one object act like each by itself.
TEST(Append, KeepsJointsAndBodies) {
  const auto door = [](const Vec3f& place) {
    BodyOptions options;
    options.position = place + Vec3f{0.5f, 0, 0};
    Object object = make_body({{Box{{0.5f, 1, 0.02f}}}}, options);
    HingeJoint hinge;
    hinge.anchor = place;
    hinge.axis = {0, 0, 1};
    add_joint(object, hinge);
    return object;
  };
  Scene scene;
  Object both = door({});
  append(both, door({3, 0, 0}));
  scene.add(both);
  ASSERT_EQ(both.bodies.size(), 4U);
  ASSERT_EQ(both.joints.size(), 2U);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const std::vector<Vec3f> at = world.object(0).positions();
  const auto moved = [&](std::size_t body) {
    return at[static_cast<std::size_t>(both.bodies[body].particle)] -
           both.positions[static_cast<std::size_t>(both.bodies[body].particle)];
  };
  EXPECT_LT(moved(0).y, -0.1f);
  EXPECT_NEAR(moved(0).y, moved(2).y, 1e-4);
}

}  // namespace
}  // namespace pliant
