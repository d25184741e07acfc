// Tests of limits, motors and friction in joints.
#include <gtest/gtest.h>

#include "joint_support.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A box of 2 kg whose centre is 1 m from a horizontal hinge at the origin: its weight has a moment of 2 g there.
int arm(Mechanism& m, HingeJoint joint) {
  joint.b = m.box({1, 0, 0}, 2);
  joint.anchor = {0, 0, 0};
  joint.axis = {0, 0, 1};
  add_joint(m.object, joint);
  return joint.b;
}
constexpr float moment = 2 * 9.81f;

TEST(JointLimits, AnArmFallsToTheEndOfItsRangeAndStaysThere) {
  Mechanism m;
  const int b = arm(m, {.limit = JointRange{-0.7f, 0.2f}});
  m.run(0.1);
  EXPECT_LT(m.turned(b).z, -0.02) << "free within the range";
  m.run(4);
  EXPECT_NEAR(m.turned(b).z, -0.7, 2e-3);
  EXPECT_LT(length(m.spin(b)), 1e-2);
}

TEST(JointLimits, ARangeMayLieAcrossHalfATurn) {
  Mechanism m;
  m.scene.gravity = {0, 9.81f, 0};
  const int b = arm(m, {.limit = JointRange{-3.5f, -2.8f}});  // it starts outside and is brought in
  m.run(4);
  const double angle = m.turned(b).z;
  EXPECT_TRUE(std::fabs(angle) > 2.78) << angle;
}

TEST(JointLimits, ASoftStopYieldsByItsCompliance) {
  Mechanism m;
  const int b = arm(m, {.limit = JointRange{0, 0.2f, 0.005f}, .friction = 0.5f});
  m.run(10);
  EXPECT_NEAR(m.turned(b).z, -0.005 * double(moment), 0.005 * 0.6 + 1e-3);
}

TEST(JointLimits, ASliderStopsAtItsRange) {
  Mechanism m;
  const int b = m.box({0, 0, 0});
  add_joint(m.object, SliderJoint{.b = b, .axis = {0, 1, 0}, .limit = JointRange{-0.3f, 0.1f}});
  m.run(2);
  EXPECT_NEAR(m.pose(b).position.y, -0.3, 1e-4);
}

TEST(JointLimits, ABallStopsAtItsSwing) {
  Mechanism m;
  const int b = m.box({1, 0, 0}, 2);
  add_joint(m.object, BallJoint{.b = b, .anchor = {0, 0, 0}, .axis = {1, 0, 0}, .most_swing = 0.5f});
  m.run(4);
  const Vec3d at = m.pose(b).position;
  EXPECT_NEAR(std::atan2(-at.y, at.x), 0.5, 5e-3);
}

TEST(JointLimits, ABallStopsAtItsTwist) {
  Mechanism m;
  m.scene.gravity = {};
  const int b = m.box({1, 0, 0}, 2, {0.5f, 0.2f, 0.2f}, {}, {4, 0, 0});
  add_joint(m.object, BallJoint{.b = b, .axis = {1, 0, 0}, .twist = JointRange{-1, 1}, .friction = 0.05f});
  m.run(3);
  EXPECT_NEAR(m.turned(b).x, 1, 5e-3);
}

TEST(JointMotors, AMotorKeepsItsSpeed) {
  Mechanism m;
  const int b = arm(m, {.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 3, .most = 2000}});
  m.run(1);
  EXPECT_NEAR(m.spin(b).z, 3, 0.03);
  EXPECT_NEAR(m.turned(b).z, 3, 0.05);
}

TEST(JointMotors, ATorqueLimitGivesTheKnownAcceleration) {
  Mechanism m;
  m.scene.gravity = {};
  const int b = arm(m, {.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 100, .most = 4}});
  m.run(0.5);
  const double inertia = box_inertia(2, 0.5, 0.1) + 2;
  EXPECT_NEAR(m.spin(b).z, 4 / inertia * 0.5, 0.01);
}

TEST(JointMotors, AMotorReachesItsAngleAgainstGravityIfItsTorqueSuffices) {
  for (const float most : {2 * moment, 0.5f * moment}) {
    Mechanism m;
    const int b = arm(m, {.motor = JointMotor{.kind = JointMotor::Kind::position, .target = 0.8f, .most = most}});
    m.run(4);
    if (most > moment)
      EXPECT_NEAR(m.turned(b).z, 0.8, 5e-3);
    else
      EXPECT_LT(m.turned(b).z, -0.5) << "too weak";
  }
}

TEST(JointMotors, ASliderMotorReachesItsPlace) {
  Mechanism m;
  const int b = m.box({0, 0, 0}, 2);
  SliderJoint joint{.b = b, .axis = {0, 1, 0}};
  joint.motor = JointMotor{.kind = JointMotor::Kind::position, .target = 1.5f, .most = 30, .most_speed = 1};
  add_joint(m.object, joint);
  m.run(1);
  EXPECT_NEAR(m.velocity(b).y, 1, 0.02);
  m.run(3);
  EXPECT_NEAR(m.pose(b).position.y, 1.5, 2e-3);
}

TEST(JointFriction, AnArmIsHeldUpToTheGreatestTorque) {
  for (const float share : {1.05f, 0.9f}) {
    Mechanism m;
    const int b = arm(m, {.friction = share * moment});
    m.run(1);
    if (share > 1)
      EXPECT_LT(length(m.turned(b)), 1e-4);
    else
      EXPECT_LT(m.turned(b).z, -0.1);
  }
}

TEST(JointFriction, ASpinningWheelStopsWhenItsFrictionHasTakenItsMomentum) {
  Mechanism m;
  m.scene.gravity = {};
  const int b = m.box({0, 0, 0}, 3, {0.4f, 0.4f, 0.1f}, {}, {0, 0, 5});
  add_joint(m.object, HingeJoint{.b = b, .axis = {0, 0, 1}, .friction = 0.4f});
  const double stop = box_inertia(3, 0.4, 0.4) * 5 / 0.4;
  m.run(std::floor(stop * 30) / 60);
  const double half = m.spin(b).z;
  EXPECT_NEAR(half, 2.5, 0.05);
  m.run(stop);
  EXPECT_LT(length(m.spin(b)), 1e-4);
}

TEST(JointFriction, ASliderHoldsUpToTheGreatestForce) {
  for (const float share : {1.05f, 0.5f}) {
    Mechanism m;
    const int b = m.box({0, 0, 0}, 2);
    add_joint(m.object, SliderJoint{.b = b, .axis = {0, 1, 0}, .friction = share * moment});
    m.run(0.5);
    EXPECT_NEAR(m.pose(b).position.y, share > 1 ? 0 : -0.25 * gravity * 0.25, 0.02);
  }
}

/// A wheel on a damped hinge: its spin is w0 exp(-c t / I), of implicit Euler's (1 + c h / I)^-n.
TEST(JointDamping, SlowsAWheelExponentially) {
  Mechanism m;
  m.scene.gravity = {};
  const int b = m.box({0, 0, 0}, 3, {0.4f, 0.4f, 0.1f}, {}, {0, 0, 5});
  add_joint(m.object, HingeJoint{.b = b, .axis = {0, 0, 1}, .damping = 0.4f});
  m.run(1);
  const double rate = 0.4 / box_inertia(3, 0.4, 0.4);
  EXPECT_NEAR(m.spin(b).z, 5 * std::exp(-rate), 0.01 * 5 * std::exp(-rate));
}

/// What falls along a damped slider ends at m g / c.
TEST(JointDamping, GivesASliderItsTerminalSpeed) {
  Mechanism m;
  const int b = m.box({0, 0, 0}, 2);
  add_joint(m.object, SliderJoint{.b = b, .axis = {0, 1, 0}, .damping = 10});
  m.run(2);
  const double before = m.pose(b).position.y;
  m.run(0.5);
  EXPECT_NEAR((m.pose(b).position.y - before) / 0.5, -2 * gravity / 10, 0.01);
  EXPECT_THROW(add_joint(m.object, SliderJoint{.b = b, .damping = -1}), Error);
}

/// Bars of 1 and 2 m between hinges, and a crank of 0.5 m that a motor turns: the loop closes in every position.
TEST(JointLoops, AFourBarLinkageClosesAndFollowsItsCrank) {
  Mechanism m;
  m.substeps = 50;
  const auto bar = [&](double x0, double y0, double x1, double y1) {
    const double length = std::hypot(x1 - x0, y1 - y0), half = std::atan2(y1 - y0, x1 - x0) / 2;
    BodyOptions options;
    options.position = {float((x0 + x1) / 2), float((y0 + y1) / 2), 0};
    options.rotation = convert<float>(Quatd{0, 0, std::sin(half), std::cos(half)});
    options.mass = 1;
    return add_body(m.object, {{Box{{float(length / 2), 0.05f, 0.05f}}, {}, {}, 1000}}, options);
  };
  // crank from (0,0) to (0,0.5), coupler to (2, 1.5), rocker to (2, 0)
  const int crank = bar(0, 0, 0, 0.5), coupler = bar(0, 0.5, 2, 1.5), rocker = bar(2, 1.5, 2, 0);
  HingeJoint driven{.b = crank, .anchor = {0, 0, 0}};
  driven.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 3, .most = 200};
  add_joint(m.object, driven);
  add_joint(m.object, HingeJoint{.a = crank, .b = coupler, .anchor = {0, 0.5f, 0}});
  add_joint(m.object, HingeJoint{.a = coupler, .b = rocker, .anchor = {2, 1.5f, 0}});
  add_joint(m.object, HingeJoint{.b = rocker, .anchor = {2, 0, 0}});
  const double coupler_length = std::hypot(2, 1);
  for (int frame = 0; frame < 180; ++frame) {
    m.run(1 / 60.);
    const Vec3d pin = m.place(crank, {0, 0.5f, 0}), end = m.place(rocker, {2, 1.5f, 0});
    EXPECT_NEAR(length(pin), 0.5, 1e-3);
    EXPECT_NEAR(length(end - Vec3d{2, 0, 0}), 1.5, 1e-3);
    EXPECT_NEAR(length(end - pin), coupler_length, 1e-3) << "the position of a four-bar linkage";
  }
  EXPECT_NEAR(m.spin(crank).z, 3, 0.1);
}

}  // namespace
}  // namespace pliant
