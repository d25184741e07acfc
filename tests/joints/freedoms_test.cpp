// Tests of every joint of two bodies in the same way: what is free moves as it would without the joint, what is locked
// stays; then limits, motors and friction of the joints with two freedoms or more.
#include <gtest/gtest.h>

#include <functional>

#include "joint_support.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A cube, whose inertia is the same about all axes, with the joint at its centre: displacement and rotation are then
/// independent.
struct Cube : Mechanism {
  static constexpr float half = 0.2f, mass = 2;
  static constexpr Vec3f start{1, 2, 3};
  int body;

  explicit Cube(const Vec3f& velocity = {}, const Vec3f& spin = {})
      : body(box(start, mass, {half, half, half}, velocity, spin)) {}
  Vec3d moved() const { return pose(body).position - wide(start); }
  static double inertia() { return box_inertia(double(mass), double(half), double(half)); }
};

/// Which displacements along x, y, z and rotations about them a joint permits, and how it is added.
struct Freedoms {
  const char* name;
  Vec3d free_motion, free_rotation;
  std::function<void(Object&, int)> add;
};

std::vector<Freedoms> joints() {
  const Vec3f at = Cube::start;
  const auto six = [at](Object& object, int b) {
    SixAxisJoint joint{.b = b, .anchor = at};
    joint.linear[1].kind = joint.angular[2].kind = AxisFreedom::Kind::free;
    add_joint(object, joint);
  };
  return {
      {"ball", {0, 0, 0}, {1, 1, 1}, [at](Object& o, int b) { add_joint(o, BallJoint{.b = b, .anchor = at}); }},
      {"fixed", {0, 0, 0}, {0, 0, 0}, [at](Object& o, int b) { add_joint(o, FixedJoint{.b = b, .anchor = at}); }},
      {"hinge",
       {0, 0, 0},
       {0, 0, 1},
       [at](Object& o, int b) {
         add_joint(o, HingeJoint{.b = b, .anchor = at, .axis = {0, 0, 1}});
       }},
      {"slider",
       {0, 1, 0},
       {0, 0, 0},
       [at](Object& o, int b) {
         add_joint(o, SliderJoint{.b = b, .anchor = at, .axis = {0, 1, 0}});
       }},
      {"cylindrical",
       {1, 0, 0},
       {1, 0, 0},
       [at](Object& o, int b) {
         add_joint(o, CylindricalJoint{.b = b, .anchor = at, .axis = {1, 0, 0}});
       }},
      {"universal",
       {0, 0, 0},
       {1, 0, 0},  // of its two freedoms the first: angular velocity about one axis alone stays on it
       [at](Object& o, int b) {
         add_joint(o, UniversalJoint{.b = b, .anchor = at, .axis_a = {1, 0, 0}, .axis_b = {0, 1, 0}});
       }},
      {"universal",
       {0, 0, 0},
       {0, 1, 0},
       [at](Object& o, int b) {
         add_joint(o, UniversalJoint{.b = b, .anchor = at, .axis_a = {1, 0, 0}, .axis_b = {0, 1, 0}});
       }},
      {"planar",
       {1, 0, 1},
       {0, 1, 0},
       [at](Object& o, int b) {
         add_joint(o, PlanarJoint{.b = b, .anchor = at, .normal = {0, 1, 0}, .axis_x = Vec3f{1, 0, 0}});
       }},
      {"six_axis", {0, 1, 0}, {0, 0, 1}, six},
  };
}

Vec3d product(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// A body turns about one axis at a time: rotations about several do not add up.
TEST(JointFreedoms, WhatIsFreeMovesAndWhatIsLockedStays) {
  const Vec3d gravity_here{1, -2, 0.5}, velocity{0.5, 0.25, -0.5};
  const double seconds = 0.5;
  for (const Freedoms& joint : joints())
    for (const Vec3d& spin : {Vec3d{1.5, 0, 0}, Vec3d{0, 1.5, 0}, Vec3d{0, 0, 1.5}}) {
      if (std::string(joint.name) == "universal" && dot(spin, joint.free_rotation) == 0 && spin.z == 0) continue;
      Cube m(convert<float>(velocity), convert<float>(spin));
      m.scene.gravity = convert<float>(gravity_here);
      joint.add(m.object, m.body);
      m.run(seconds);
      const Vec3d fall = velocity * seconds + gravity_here * (seconds * seconds / 2),
                  known = product(fall, joint.free_motion);
      EXPECT_LT(length(m.moved() - known), 0.01 * length(known) + 1e-5) << joint.name;
      EXPECT_LT(length(m.turned(m.body) - product(spin * seconds, joint.free_rotation)), 1e-3) << joint.name;
    }
}

TEST(JointFreedoms, LockedDirectionsCarryAnOffsetWeight) {
  for (const Freedoms& joint : joints()) {
    Cube m;
    m.scene.gravity = convert<float>(Vec3d{3, -4, 5} - product({3, -4, 5}, joint.free_motion));
    joint.add(m.object, m.body);
    m.run(1);
    EXPECT_LT(length(m.moved()), 1e-5) << joint.name;
    EXPECT_LT(length(m.turned(m.body)), 1e-5) << joint.name;
  }
}

// ---------------------------------------------------------------- limits

constexpr JointRange joint_range{-0.25f, 0.5f};

/// The displacement or angle of a cube along an axis after it has moved towards both ends of `joint_range`.
template <class Joint>
void expect_stops(const std::function<void(Joint&)>& set, bool is_angle, int axis) {
  for (const float sign : {1.f, -1.f}) {
    Vec3f motion{};
    (axis == 0 ? motion.x : axis == 1 ? motion.y : motion.z) = sign;
    Cube m(is_angle ? Vec3f{} : motion, is_angle ? motion : Vec3f{});
    m.scene.gravity = {};
    Joint joint{.b = m.body, .anchor = Cube::start};
    set(joint);
    add_joint(m.object, joint);
    m.run(0.2);
    const auto along = [&] {
      const Vec3d v = is_angle ? m.turned(m.body) : m.moved();
      return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
    };
    EXPECT_NEAR(along(), 0.2 * double(sign), 2e-3) << "free within its range";
    m.run(1);
    EXPECT_NEAR(along(), double(sign > 0 ? joint_range.high : joint_range.low), 1e-3) << axis;
  }
}

TEST(JointFreedoms, AUniversalJointStopsAtTheLimitsOfBothAngles) {
  expect_stops<UniversalJoint>([](auto& j) { j.limit_a = joint_range; }, true, 0);
  expect_stops<UniversalJoint>([](auto& j) { j.limit_b = joint_range; }, true, 1);
}

TEST(JointFreedoms, APlanarJointStopsAtItsThreeLimits) {
  const auto set = [](PlanarJoint& j) { j.normal = {0, 1, 0}, j.axis_x = Vec3f{0, 0, 1}; };  // y is then x
  expect_stops<PlanarJoint>([&](auto& j) { set(j), j.x_limit = joint_range; }, false, 2);
  expect_stops<PlanarJoint>([&](auto& j) { set(j), j.y_limit = joint_range; }, false, 0);
  expect_stops<PlanarJoint>([&](auto& j) { set(j), j.turn_limit = joint_range; }, true, 1);
}

TEST(JointFreedoms, ACylindricalJointStopsAtBothLimits) {
  expect_stops<CylindricalJoint>([](auto& j) { j.axis = {0, 1, 0}, j.slide_limit = joint_range; }, false, 1);
  expect_stops<CylindricalJoint>([](auto& j) { j.axis = {0, 1, 0}, j.turn_limit = joint_range; }, true, 1);
}

// ---------------------------------------------------------------- motors

JointMotor to(float target) { return {.kind = JointMotor::Kind::position, .target = target, .most = 500}; }

Quatd about(const Vec3d& axis, double angle) {
  const Vec3d v = axis * std::sin(angle / 2);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

/// The angle of the rotation between two orientations [rad].
double between(const Quatd& a, const Quatd& b) {
  const Quatd q = multiply(conjugate(a), b);
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::fabs(q.w));
}

TEST(JointFreedoms, MotorsOfAUniversalJointTurnItsCrossThenItsBody) {
  Cube m;
  UniversalJoint joint{.b = m.body, .anchor = Cube::start, .axis_a = {0, 0, 1}, .axis_b = {0, 1, 0}};
  joint.motor_a = to(0.7f), joint.motor_b = to(-1.2f);
  add_joint(m.object, joint);
  m.run(3);
  EXPECT_LT(between(m.pose(m.body).rotation, multiply(about({0, 0, 1}, 0.7), about({0, 1, 0}, -1.2))), 2e-3);
  EXPECT_LT(length(m.moved()), 1e-5);
}

TEST(JointFreedoms, MotorsOfAPlanarJointMoveAndTurnItsBody) {
  Cube m;
  m.scene.gravity = {5, 5, 5};
  PlanarJoint joint{.b = m.body, .anchor = {1.5f, 2, 3}, .normal = {0, 0, 2}, .axis_x = Vec3f{0, 1, 0}};
  joint.x_motor = to(0.5f), joint.y_motor = to(0.25f), joint.turn_motor = to(-0.6f);
  add_joint(m.object, joint);
  m.run(3);
  EXPECT_LT(length(m.place(m.body, {1.5f, 2, 3}) - Vec3d{1.25, 2.5, 3}), 2e-3) << "y is z times y, so -x";
  EXPECT_LT(length(m.turned(m.body) - Vec3d{0, 0, -0.6}), 2e-3);
}

TEST(JointFreedoms, MotorsOfACylindricalJointSlideAndTurnItsBody) {
  Cube m;
  CylindricalJoint joint{.b = m.body, .anchor = Cube::start, .axis = {0, 1, 0}};
  joint.slide_motor = to(0.5f), joint.turn_motor = to(1.1f);
  add_joint(m.object, joint);
  m.run(3);
  EXPECT_LT(length(m.moved() - Vec3d{0, 0.5, 0}), 2e-3);
  EXPECT_LT(length(m.turned(m.body) - Vec3d{0, 1.1, 0}), 2e-3);
}

TEST(JointFreedoms, MotorsOfSixAxesMoveAndTurnItsBody) {
  for (int axis = 0; axis < 3; ++axis) {
    Cube m;
    SixAxisJoint joint{.b = m.body, .anchor = Cube::start};
    const auto k = static_cast<std::size_t>(axis);
    joint.linear[k] = {.kind = AxisFreedom::Kind::free, .motor = to(-0.5f)};
    joint.angular[k] = {.kind = AxisFreedom::Kind::free, .motor = to(0.8f)};
    add_joint(m.object, joint);
    m.run(3);
    const Vec3d unit{axis == 0 ? 1. : 0., axis == 1 ? 1. : 0., axis == 2 ? 1. : 0.};
    EXPECT_LT(length(m.moved() - unit * -0.5), 2e-3) << axis;
    EXPECT_LT(length(m.turned(m.body) - unit * 0.8), 2e-3) << axis;
  }
}

/// A motor of `most` that is asked for more speed than it can reach gives the acceleration most / mass, or most /
/// inertia.
TEST(JointFreedoms, AMotorGivesTheAccelerationOfItsLimit) {
  const JointMotor weak{.kind = JointMotor::Kind::speed, .target = 1000, .most = 0.1f};
  const double seconds = 0.5, force = 0.1;
  for (int axis = 0; axis < 2; ++axis) {
    Cube turns, slides;
    turns.scene.gravity = slides.scene.gravity = {};
    UniversalJoint cross{.b = turns.body, .anchor = Cube::start};
    (axis == 0 ? cross.motor_a : cross.motor_b) = weak;
    add_joint(turns.object, cross);
    PlanarJoint plane{.b = slides.body, .anchor = Cube::start, .axis_x = Vec3f{1, 0, 0}};
    (axis == 0 ? plane.x_motor : plane.y_motor) = weak;
    add_joint(slides.object, plane);
    turns.run(seconds), slides.run(seconds);
    EXPECT_NEAR(length(turns.spin(turns.body)), force / Cube::inertia() * seconds, 1e-3);
    EXPECT_NEAR(length(slides.velocity(slides.body)), force / double(Cube::mass) * seconds, 1e-4);
  }
}

// ---------------------------------------------------------------- friction

TEST(JointFreedoms, FrictionTakesTheMomentumAtItsRate) {
  const double torque = 0.05, seconds = 0.5;
  for (int axis = 0; axis < 2; ++axis) {
    Cube m({}, axis == 0 ? Vec3f{2, 0, 0} : Vec3f{0, 2, 0});
    m.scene.gravity = {};
    UniversalJoint joint{.b = m.body, .anchor = Cube::start};
    (axis == 0 ? joint.friction_a : joint.friction_b) = static_cast<float>(torque);
    add_joint(m.object, joint);
    m.run(seconds);
    EXPECT_NEAR(length(m.spin(m.body)), 2 - torque / Cube::inertia() * seconds, 1e-3);
  }
  Cube m({1, 0, -0.5f}, {0, 2, 0});
  m.scene.gravity = {};
  add_joint(m.object, PlanarJoint{.b = m.body,
                                  .anchor = Cube::start,
                                  .normal = {0, 1, 0},
                                  .axis_x = Vec3f{1, 0, 0},
                                  .slide_friction = 1,
                                  .turn_friction = static_cast<float>(torque)});
  m.run(seconds);
  const double slower = 1 / double(Cube::mass) * seconds;
  EXPECT_LT(length(m.velocity(m.body) - Vec3d{1 - slower, 0, -0.5 + slower}), 1e-3);
  EXPECT_NEAR(m.spin(m.body).y, 2 - torque / Cube::inertia() * seconds, 1e-3);
}

/// Where one angle of a universal joint is half a turn, the other cannot be measured (twist_of); a body that passes
/// there often, with friction about both axes, keeps its joint and gains no energy.
TEST(JointFreedoms, AUniversalJointWithFrictionPassesHalfATurn) {
  Mechanism m;
  const int b = m.box({0, -1, 0}, 1, {0.1f, 0.1f, 0.1f}, {9, 0, 0.3f}, {0, 0, 9});
  add_joint(m.object, UniversalJoint{.b = b,
                                     .anchor = {0, 0, 0},
                                     .axis_a = {0, 0, 1},
                                     .axis_b = {1, 0, 0},
                                     .friction_a = 0.02f,
                                     .friction_b = 0.02f});
  m.start();
  const auto energy = [&] { return m.world->measure().kinetic_energy() + m.world->measure().potential_energy(); };
  const double start = energy();
  double before = m.turned(b).z;
  int passes = 0;
  for (int frame = 0; frame < 300; ++frame) {
    m.run(1 / 60.);
    if (before > 2 && m.turned(b).z < -2) ++passes;
    before = m.turned(b).z;
    EXPECT_LT(length(m.place(b, {0, 0, 0})), 1e-4) << frame;
    EXPECT_LT(energy(), start + 0.02 * 9 * 9 / 2) << frame;
  }
  EXPECT_GT(passes, 2);
}

// ---------------------------------------------------------------- joints between two anchors

TEST(JointFreedoms, ARodLetsItsBodyCircleAndSpin) {
  Cube m({0, 2, 0}, {0, 0, 3});
  m.scene.gravity = {};
  add_joint(m.object, DistanceJoint{.b = m.body, .anchor_a = {0, 2, 3}, .anchor_b = Cube::start});
  m.run(1);
  const Vec3d known{std::cos(2.), 2 + std::sin(2.), 3};  // 2 rad on a circle of 1 m
  EXPECT_LT(length(m.pose(m.body).position - known), 1e-2);
  EXPECT_NEAR(length(m.pose(m.body).position - Vec3d{0, 2, 3}), 1, 1e-4);
  EXPECT_LT(length(m.turned(m.body) - Vec3d{0, 0, 3}), 1e-3);
}

TEST(JointFreedoms, ARangeOfDistancesIsFreeBetweenItsEnds) {
  for (const float sign : {1.f, -1.f}) {
    Cube m({sign, 0, 0});
    m.scene.gravity = {};
    DistanceJoint joint{.b = m.body, .anchor_a = {0, 2, 3}, .anchor_b = Cube::start};
    joint.least = 1 + joint_range.low, joint.most = 1 + joint_range.high;
    add_joint(m.object, joint);
    m.run(0.2);
    EXPECT_NEAR(m.moved().x, 0.2 * double(sign), 1e-3);
    m.run(1);
    EXPECT_NEAR(m.moved().x, double(sign > 0 ? joint_range.high : joint_range.low), 1e-3);
  }
}

/// A spring acts along its line alone, with the frequency of its stiffness; a body that its anchor is the centre of
/// spins freely.
TEST(JointFreedoms, ASpringOscillatesAtItsFrequencyAndLeavesTheRestFree) {
  Cube m({0.5f, 0, 0}, {0, 3, 0});
  m.scene.gravity = {};
  m.substeps = 100;
  const double stiffness = 80, rate = std::sqrt(stiffness / double(Cube::mass));
  add_joint(
      m.object,
      SpringJoint{
          .b = m.body, .anchor_a = {0, 2, 3}, .anchor_b = Cube::start, .stiffness = static_cast<float>(stiffness)});
  for (int frame = 1; frame <= 60; ++frame) {
    m.run(1 / 60.);
    // The implicit spring loses rate^2 h / 2 of its amplitude a second.
    const double seconds = frame / 60., lost = rate * rate / 6000 / 2 * seconds;
    EXPECT_LT(length(m.moved() - Vec3d{0.5 / rate * std::sin(rate * seconds), 0, 0}), 0.5 / rate * (lost + 2e-3))
        << frame;
  }
  EXPECT_LT(length(m.turned(m.body) - Vec3d{0, 3, 0}), 1e-3);
}

/// The rope of a pulley only pulls: weights that both move upwards are free, and one that falls alone is caught.
TEST(JointFreedoms, ARopeOverPulleysIsSlackUntilItIsLongEnough) {
  Mechanism m;
  const int a = m.box({-1, 0, 0}, 1, {0.1f, 0.1f, 0.1f}, {0, 2, 0}),
            b = m.box({1, 0, 0}, 1, {0.1f, 0.1f, 0.1f}, {0, 2, 0});
  add_joint(m.object, PulleyJoint{.a = a,
                                  .b = b,
                                  .anchor_a = {-1, 0, 0},
                                  .anchor_b = {1, 0, 0},
                                  .pulley_a = {-1, 5, 0},
                                  .pulley_b = {1, 5, 0}});
  m.run(0.2);
  for (const int body : {a, b}) EXPECT_NEAR(m.pose(body).position.y, 0.4 - gravity * 0.02, 0.01);
  m.run(2);
  EXPECT_NEAR(m.pose(a).position.y + m.pose(b).position.y, 0, 1e-3);
}

/// The problem for which a joint is refused; empty if it is added.
template <class Joint>
std::string problem_of(Object& object, const Joint& joint) {
  try {
    add_joint(object, joint);
  } catch (const Error& error) {
    return error.problem();
  }
  return {};
}

/// Scene files have degrees and the C++ API has radians, so messages have both.
TEST(JointFreedoms, WrongRangesAndAxesAreNamed) {
  Cube m;
  EXPECT_EQ(problem_of(m.object, HingeJoint{.b = m.body, .axis = {0, 0, 0}}), "has an axis of length zero");
  EXPECT_EQ(problem_of(m.object, HingeJoint{.b = m.body, .limit = JointRange{-6, 3}}),
            "has a range of 9 rad (515.7 degrees)");
  EXPECT_EQ(problem_of(m.object, HingeJoint{.b = m.body, .limit = JointRange{0.5f, 0.25f}}),
            "has a range from 0.5 rad (28.65 degrees) to 0.25 rad (14.32 degrees)");
  EXPECT_EQ(problem_of(m.object, SliderJoint{.b = m.body, .limit = JointRange{0.5f, 0.25f}}),
            "has a range from 0.5 m to 0.25 m");
}

TEST(JointFreedoms, APlaneNeedsItsXForLimits) {
  Cube m;
  const auto refusal = [&](const PlanarJoint& joint) { return problem_of(m.object, joint); };
  EXPECT_EQ(refusal({.b = m.body, .x_limit = joint_range}),
            "has limits, motors or springs in its plane, but no axis_x");
  EXPECT_EQ(refusal({.b = m.body, .axis_x = Vec3f{1, 1, 0}}), "has an axis_x that is not in its plane");
  EXPECT_EQ(refusal({.b = m.body, .turn_limit = joint_range}), "");
}

}  // namespace
}  // namespace pliant
