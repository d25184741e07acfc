// Tests that a motor does not drive a joint through its stop.
#include <gtest/gtest.h>

#include <cmath>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float dt = 1.f / 60;

/// An arm of 32 kg that a motor turns about y against a stop at 0.5 rad.
Scene arm_with_motor(float most, bool to_position) {
  Scene scene;
  scene.gravity = {};
  Object arm;
  arm.name = "arm";
  add_body(arm, {{Box{{0.5f, 0.1f, 0.1f}}}}, {.position = {0.5f, 0, 0}, .mass = 32});
  JointMotor motor{.target = 1, .most = most};
  if (to_position) motor.kind = JointMotor::Kind::position, motor.target = 1.5f;
  add_joint(arm, HingeJoint{.b = 0, .anchor = {}, .axis = {0, 1, 0}, .limit = JointRange{-0.2f, 0.5f}, .motor = motor});
  scene.add(arm);
  return scene;
}

TEST(Stops, HoldAgainstTheMotorOfTheSameHinge) {
  for (const bool to_position : {false, true})
    for (const float most : {5.f, 20.f, 1000.f}) {
      World world(arm_with_motor(most, to_position));
      for (int frame = 0; frame < 240; ++frame) {
        ASSERT_TRUE(world.step(dt).ok());
        const Vec3f x = world.object(0).positions()[0];
        const double angle = std::atan2(-static_cast<double>(x.z), static_cast<double>(x.x));
        ASSERT_LT(angle, 0.5 + 1e-3) << most << " N m, frame " << frame;
        ASSERT_TRUE(frame < 200 || angle > 0.5 - 1e-3) << most << " N m, angle " << angle;
      }
    }
}

TEST(Stops, HoldAgainstTheMotorOfTheSameSlider) {
  for (const float most : {10.f, 1e4f}) {
    Scene scene;
    scene.gravity = {};
    Object cart;
    cart.name = "cart";
    add_body(cart, {{Box{{0.1f, 0.1f, 0.1f}}}}, {.mass = 10});
    add_joint(cart,
              SliderJoint{.b = 0, .limit = JointRange{-0.2f, 0.5f}, .motor = JointMotor{.target = 1, .most = most}});
    scene.add(cart);
    World world(scene);
    for (int frame = 0; frame < 240; ++frame) {
      ASSERT_TRUE(world.step(dt).ok());
      ASSERT_LT(world.object(0).positions()[0].x, 0.5 + 1e-3) << most << " N, frame " << frame;
    }
    EXPECT_GT(world.object(0).positions()[0].x, 0.5 - 1e-3) << most;
  }
}

/// The angle about y at which an arm is that starts at `start` and turns to `target` within a range [rad].
double angle_after(const JointRange& range, float start, float target) {
  Scene scene;
  scene.gravity = {};
  Object arm;
  arm.name = "arm";
  add_body(arm, {{Box{{0.5f, 0.1f, 0.1f}}}}, {.position = {0.5f, 0, 0}, .mass = 32});
  JointMotor motor{.kind = JointMotor::Kind::position, .target = start, .most = 1e5f};
  add_joint(arm, HingeJoint{.b = 0, .anchor = {}, .axis = {0, 1, 0}, .limit = range, .motor = motor});
  scene.add(arm);
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) EXPECT_TRUE(world.step(dt).ok());
  world.object(0).set_motor(arm.joints[0].name, {.target = target});
  for (int frame = 0; frame < 240; ++frame) EXPECT_TRUE(world.step(dt).ok());
  const Vec3f x = world.object(0).positions()[0];
  return std::remainder(std::atan2(-static_cast<double>(x.z), static_cast<double>(x.x)) - static_cast<double>(target),
                        2 * 3.14159265358979);
}

TEST(Stops, AreNotOnTheWayOfAPositionMotor) {
  EXPECT_NEAR(angle_after({0, 5.236f}, 0, 4.363f), 0, 1e-3) << "0 to 300 degrees, to 250";
  EXPECT_NEAR(angle_after({-0.0175f, 3.7525f}, 0, 3.6f), 0, 1e-3) << "an elbow of a real arm";
  EXPECT_NEAR(angle_after({-3, 3}, -2.8f, 2.8f), 0, 1e-3);
  EXPECT_NEAR(angle_after({-3, 3}, 2.8f, -2.8f), 0, 1e-3);
}

TEST(Stops, MayBeAFullTurnApart) {
  for (const float half : {3.14159265359f, 3.1415925f})
    EXPECT_NEAR(angle_after({-half, half}, 0, 3), 0, 1e-3) << "-180 to 180 degrees";
}

}  // namespace
}  // namespace pliant
