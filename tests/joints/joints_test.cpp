// Tests of each joint: its free directions move as the laws of motion say, its locked ones do not.
#include <gtest/gtest.h>

#include "joint_support.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The period of small swings about z of body `b`, which hangs below its anchor [s].
double period(Mechanism& m, int b, double seconds) {
  m.start();
  std::vector<double> crossings;
  double before = m.turned(b).z;
  for (int frame = 0; frame < static_cast<int>(seconds * 60); ++frame) {
    m.run(frame_time);
    const double now = m.turned(b).z + 0;
    const double swing = now, last = before;
    before = now;
    if (last < 0.05 && swing >= 0.05) crossings.push_back((frame + (0.05 - last) / (swing - last)) / 60);
  }
  if (crossings.size() < 2) return 0;
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

/// A box that hangs from the world at its upper end, turned by 0.05 rad out of the vertical.
int hanging_box(Mechanism& m) {
  BodyOptions options;
  options.position = {0.5f * std::sin(-0.05f), -0.5f * std::cos(0.05f), 0};
  options.rotation = convert<float>(Quatd{0, 0, std::sin(-0.025), std::cos(-0.025)});
  options.mass = 2;
  return add_body(m.object, {{Box{{0.05f, 0.5f, 0.1f}}, {}, {}, 1000}}, options);
}

double known_period() {
  const double about_centre = box_inertia(2, 0.05, 0.5);
  return 2 * pi * std::sqrt((about_centre + 2 * 0.25) / (2 * gravity * 0.5)) * (1 + 0.05 * 0.05 / 16);
}

TEST(Joints, ABoxOnABallSwingsWithThePeriodOfACompoundPendulum) {
  Mechanism m;
  m.substeps = 100;
  const int b = hanging_box(m);
  add_joint(m.object, BallJoint{.b = b, .anchor = {0, 0, 0}});
  EXPECT_NEAR(period(m, b, 8) / known_period(), 1, 2e-3);
  EXPECT_LT(length(m.place(b, {0, 0, 0})), 1e-5);
}

TEST(Joints, ABoxOnAHingeSwingsWithThePeriodOfACompoundPendulum) {
  Mechanism m;
  m.substeps = 100;
  const int b = hanging_box(m);
  add_joint(m.object, HingeJoint{.b = b, .anchor = {0, 0, 0.3f}, .axis = {0, 0, 2}});
  EXPECT_NEAR(period(m, b, 8) / known_period(), 1, 2e-3);
  EXPECT_LT(length(m.place(b, {0, 0, 0})), 1e-5);
}

TEST(Joints, ABallLetsABoxSpinAboutAnyAxisThroughIt) {
  for (const Vec3f spin : {Vec3f{2, 0, 0}, Vec3f{0, 2, 0}, Vec3f{0, 0, 2}}) {
    Mechanism m;
    m.scene.gravity = {};
    const int b = m.box({1, 2, 3}, 1, {0.3f, 0.3f, 0.3f}, {}, spin);
    add_joint(m.object, BallJoint{.b = b, .anchor = {1, 2, 3}});
    m.run(0.5);
    EXPECT_LT(length(m.turned(b) - wide(spin) * 0.5), 1e-3);
    EXPECT_LT(length(m.pose(b).position - Vec3d{1, 2, 3}), 1e-6);
  }
}

TEST(Joints, AFixedBoxStaysThoughGravityBendsItsJoint) {
  Mechanism m;
  const int b = m.box({1, 0, 0}, 5);
  add_joint(m.object, FixedJoint{.b = b, .anchor = {0, 0, 0}});
  m.run(2);
  EXPECT_LT(length(m.pose(b).position - Vec3d{1, 0, 0}), 1e-4);
  EXPECT_LT(length(m.turned(b)), 1e-4);
}

TEST(Joints, TwoBoxesFixedToEachOtherFallAndSpinAsOne) {
  Mechanism m;
  m.scene.gravity = {};
  const int a = m.box({-0.5f, 0, 0}, 1, {0.5f, 0.1f, 0.1f}, {0, -1, 0}, {0, 0, 2}),
            b = m.box({0.5f, 0, 0}, 1, {0.5f, 0.1f, 0.1f}, {0, 1, 0}, {0, 0, 2});
  add_joint(m.object, FixedJoint{.a = a, .b = b, .anchor = {0, 0, 0}});
  m.run(1);
  EXPECT_NEAR(m.turned(a).z, 2, 0.02);
  EXPECT_LT(length(m.turned(a) - m.turned(b)), 1e-3);
  EXPECT_LT(length(m.place(a, {0, 0, 0}) - m.place(b, {0, 0, 0})), 1e-4);
  EXPECT_LT(length(m.place(a, {0, 0, 0})), 1e-4) << "momentum";
}

TEST(Joints, AHingeTurnsAboutItsAxisAlone) {
  Mechanism m;
  m.scene.gravity = {0, 0, -9.81f};  // along the axis
  const int b = m.box({1, 0, 0}, 2, {0.5f, 0.1f, 0.1f}, {0, 1.5f, 0}, {0, 0, 1.5f});
  add_joint(m.object, HingeJoint{.b = b, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
  m.run(1);
  const Vec3d turned = m.turned(b);
  EXPECT_NEAR(turned.z, 1.5, 0.02);
  EXPECT_LT(std::hypot(turned.x, turned.y), 2e-4);
  EXPECT_LT(std::fabs(m.pose(b).position.z), 2e-4);
}

TEST(Joints, ASliderFallsAlongItsAxisWithoutTurning) {
  Mechanism m;
  const int b = m.box({0, 0, 0}, 2);
  add_joint(m.object, SliderJoint{.b = b, .anchor = {0.4f, 0.3f, 0}, .axis = {0.6f, -0.8f, 0}});
  m.run(1);
  const double way = 0.5 * gravity * 0.8;
  EXPECT_LT(length(m.pose(b).position - Vec3d{0.6, -0.8, 0} * way), 0.01 * way);
  EXPECT_LT(length(m.turned(b)), 2e-4);
  EXPECT_LT(std::fabs(dot(m.pose(b).position, Vec3d{0.8, 0.6, 0})), 1e-4);
}

TEST(Joints, ACylinderJointSlidesAndTurnsAboutItsAxis) {
  Mechanism m;
  const int b = m.box({0, 0, 0}, 2, {0.2f, 0.3f, 0.2f}, {}, {0, 3, 0});
  add_joint(m.object, CylindricalJoint{.b = b, .anchor = {0, 0.3f, 0}, .axis = {0, 1, 0}});
  m.run(0.5);
  EXPECT_NEAR(m.pose(b).position.y, -0.5 * gravity * 0.25, 0.03);
  EXPECT_NEAR(m.turned(b).y, 1.5, 5e-3);
  EXPECT_LT(std::hypot(m.pose(b).position.x, m.pose(b).position.z), 1e-4);
  EXPECT_LT(std::hypot(m.turned(b).x, m.turned(b).z), 1e-4);
}

TEST(Joints, APlanarJointKeepsItsPlane) {
  Mechanism m;
  const int b = m.box({0, 0, 0}, 2, {0.2f, 0.2f, 0.2f}, {1, 0, 0.5f}, {0, 2, 0});
  add_joint(m.object, PlanarJoint{.b = b, .anchor = {0.2f, -0.2f, 0}, .normal = {0, 1, 0}});
  m.run(1);
  EXPECT_LT(length(m.pose(b).position - Vec3d{1, 0, 0.5}), 2e-3);
  EXPECT_LT(length(m.turned(b) - Vec3d{0, 2, 0}), 2e-3);
}

/// Two shafts along x and bent by `bend` about z meet in a universal joint; the speed of the second over that of the
/// first when the first has turned by `angle` from where its fork lies in the plane of the bend.
TEST(Joints, AUniversalJointTurnsAShaftAtTheKnownRatio) {
  const double bend = 0.5;
  Mechanism m;
  m.scene.gravity = {};
  const int first = m.box({-1, 0, 0}, 1, {0.5f, 0.1f, 0.1f});
  const Vec3f along{float(std::cos(bend)), float(std::sin(bend)), 0};
  BodyOptions options;
  options.position = along;
  options.rotation = convert<float>(Quatd{0, 0, std::sin(bend / 2), std::cos(bend / 2)});
  options.mass = 0.001f;
  const int second = add_body(m.object, {{Box{{0.5f, 0.1f, 0.1f}}, {}, {}, 1000}}, options);
  HingeJoint shaft{.b = first, .anchor = {-1, 0, 0}, .axis = {1, 0, 0}};
  shaft.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 2, .most = 1000};
  add_joint(m.object, shaft);
  add_joint(m.object, HingeJoint{.b = second, .anchor = along, .axis = along});
  add_joint(m.object,
            UniversalJoint{
                .a = first, .b = second, .anchor = {0, 0, 0}, .axis_a = {0, 0, 1}, .axis_b = {-along.y, along.x, 0}});
  m.iterations = 20;
  m.run(0.5);
  for (int frame = 0; frame < 60; ++frame) {
    m.run(1 / 60.);
    const double angle = 2 * (0.5 + (frame + 1) / 60.);  // of the first fork from the normal of the plane of the shafts
    const double known = std::cos(bend) / (1 - std::pow(std::sin(bend) * std::sin(angle), 2));
    EXPECT_NEAR(dot(m.spin(second), wide(along)) / 2, known, 0.02) << frame;
  }
}

TEST(Joints, ARodKeepsItsLengthAndARopeOnlyPulls) {
  Mechanism m;
  const int rod = m.box({0, -1, 0}), rope = m.box({5, 0, 0});
  add_joint(m.object, DistanceJoint{.b = rod, .anchor_a = {0, 0, 0}, .anchor_b = {0, -1, 0}});
  add_joint(m.object, DistanceJoint{.b = rope, .anchor_a = {5, 0, 0}, .anchor_b = {5, 0, 0}, .most = 1.f});
  m.run(0.3);
  EXPECT_NEAR(m.pose(rope).position.y, -0.5 * gravity * 0.09, 0.02) << "falls while the rope is loose";
  m.run(2);
  EXPECT_NEAR(m.pose(rod).position.y, -1, 1e-4);
  EXPECT_NEAR(m.pose(rope).position.y, -1, 1e-4);
}

TEST(Joints, ASpringCarriesAWeightWhereItsForceIsTheWeight) {
  Mechanism m;
  const int b = m.box({0, -1, 0}, 2);
  add_joint(m.object,
            SpringJoint{.b = b, .anchor_a = {0, 0, 0}, .anchor_b = {0, -1, 0}, .stiffness = 200, .damping = 40});
  m.run(5);
  EXPECT_NEAR(m.pose(b).position.y, -1 - 2 * gravity / 200, 1e-3);
}

TEST(Joints, WeightsOverAPulleyAccelerateAsAtwoodFound) {
  Mechanism m;
  m.substeps = 50;
  const int a = m.box({-1, 0, 0}, 3), b = m.box({1, 0, 0}, 2);
  add_joint(m.object, PulleyJoint{.a = a,
                                  .b = b,
                                  .anchor_a = {-1, 0, 0},
                                  .anchor_b = {1, 0, 0},
                                  .pulley_a = {-1, 5, 0},
                                  .pulley_b = {1, 5, 0}});
  m.run(1);
  const double known = 0.5 * gravity * (3 - 2) / (3. + 2);
  EXPECT_NEAR(m.pose(b).position.y, known, 0.02 * known);
  EXPECT_NEAR(m.pose(a).position.y, -known, 0.02 * known);
}

TEST(Joints, ATackleOfTwoCarriesTwiceTheWeight) {
  Mechanism m;
  const int a = m.box({-1, 0, 0}, 1), b = m.box({1, 0, 0}, 2);
  add_joint(m.object, PulleyJoint{.a = a,
                                  .b = b,
                                  .anchor_a = {-1, 0, 0},
                                  .anchor_b = {1, 0, 0},
                                  .pulley_a = {-1, 5, 0},
                                  .pulley_b = {1, 5, 0},
                                  .ratio = 2});
  m.run(2);
  EXPECT_NEAR(m.pose(a).position.y, 0, 1e-3);
  EXPECT_NEAR(m.pose(b).position.y, 0, 1e-3);
}

TEST(Joints, GearsTurnAgainstEachOtherByTheirTeethForManyTurns) {
  Mechanism m;
  m.scene.gravity = {};
  const int a = m.box({0, 0, 0}, 1, {0.3f, 0.3f, 0.1f}), b = m.box({1, 0, 0}, 1, {0.3f, 0.3f, 0.1f});
  HingeJoint driven{.b = a, .anchor = {0, 0, 0}, .axis = {0, 0, 1}};
  driven.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 6, .most = 1000};
  add_joint(m.object, driven);
  add_joint(m.object, HingeJoint{.b = b, .anchor = {1, 0, 0}, .axis = {0, 0, 1}});
  add_joint(m.object, GearJoint{.a = a, .b = b, .teeth_a = 20, .teeth_b = 30});
  m.run(3);
  EXPECT_NEAR(m.spin(a).z, 6, 0.05);
  EXPECT_NEAR(m.spin(b).z, -4, 0.05);
  const double turns = std::remainder(20 * m.turned(a).z + 30 * m.turned(b).z, 2 * pi);
  EXPECT_NEAR(turns, 0, 0.02) << "no tooth was lost";
}

TEST(Joints, APinionMovesItsRackForManyTurns) {
  Mechanism m;
  m.scene.gravity = {};
  const int pinion = m.box({0, 0, 0}, 1, {0.1f, 0.1f, 0.1f}), rack = m.box({0, -0.2f, 0}, 1);
  HingeJoint driven{.b = pinion, .anchor = {0, 0, 0}, .axis = {0, 0, 1}};
  driven.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 10, .most = 1000};
  add_joint(m.object, driven);
  add_joint(m.object, SliderJoint{.b = rack, .anchor = {0, -0.2f, 0}, .axis = {1, 0, 0}});
  add_joint(m.object, RackJoint{.pinion = pinion, .rack = rack, .radius = 0.1f});
  m.run(3);
  EXPECT_NEAR(m.velocity(rack).x, 1, 0.01);
  EXPECT_NEAR(m.pose(rack).position.x, 3, 0.05);
}

/// Bodies that a joint connects do not collide, whichever parts of them it acts on.
TEST(Joints, APinionInItsRackDoesNotTouchIt) {
  Mechanism m;
  const int pinion = m.box({0, 0, 0}, 1, {0.1f, 0.1f, 0.1f}), rack = m.box({0, -0.15f, 0}, 1, {2, 0.1f, 0.1f});
  HingeJoint driven{.b = pinion, .anchor = {0, 0, 0}, .axis = {0, 0, 1}};
  driven.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 1, .most = 1000};
  add_joint(m.object, driven);
  add_joint(m.object, SliderJoint{.b = rack, .anchor = {0, -0.15f, 0}, .axis = {1, 0, 0}});
  add_joint(m.object, RackJoint{.pinion = pinion, .rack = rack, .radius = 0.1f});
  m.start();
  m.scene.objects[0].collides = m.scene.objects[0].self_collision = true;
  const Settings settings = m.world->settings();
  m.world = std::make_unique<World>(m.scene, settings);
  m.run(1);
  EXPECT_TRUE(m.world->state().body_contacts.empty());
  EXPECT_NEAR(m.pose(rack).position.x, 0.1, 2e-3);
}

TEST(Joints, SixAxesAreFreeLockedOrLimitedOneByOne) {
  using Kind = AxisFreedom::Kind;
  Mechanism m;
  m.scene.gravity = {1, -2, 3};
  const int b = m.box({0, 0, 0}, 1, {0.2f, 0.2f, 0.2f}, {}, {0.5f, 0.5f, 0.5f});
  SixAxisJoint joint{.b = b};
  joint.linear[0].kind = Kind::free;
  joint.linear[1] = {.kind = Kind::limited, .limit = {-0.25f, 0.5f}};
  joint.linear[2].kind = Kind::locked;
  joint.angular[0].kind = Kind::locked;
  joint.angular[1] = {.kind = Kind::limited, .limit = {-0.3f, 0.3f}};
  joint.angular[2].kind = Kind::locked;
  add_joint(m.object, joint);
  m.run(2);
  const Vec3d at = m.pose(b).position, turned = m.turned(b);
  EXPECT_NEAR(at.x, 2, 0.02) << "half of 1 m/s^2 for 2 s";
  EXPECT_NEAR(at.y, -0.25, 1e-3);
  EXPECT_NEAR(at.z, 0, 1e-3);
  EXPECT_NEAR(turned.y, 0.3, 1e-2);
  EXPECT_LT(std::hypot(turned.x, turned.z), 2e-3);
}

TEST(Joints, OfAnObjectHaveDifferentNames) {
  Mechanism m;
  const int b = m.box({0, 0, 0});
  BallJoint joint{.b = b};
  joint.options.name = "shoulder";
  add_joint(m.object, joint);
  EXPECT_THROW(add_joint(m.object, joint), Error);
}

TEST(Joints, WrongJointsAreNamedAndChangeNothing) {
  Mechanism m;
  const int b = m.box({0, 0, 0});
  const auto refused = [&](const auto& joint) {
    const std::size_t bodies = m.object.bodies.size(), groups = m.object.constraints.size();
    EXPECT_THROW(add_joint(m.object, joint), Error);
    EXPECT_EQ(m.object.bodies.size(), bodies);
    EXPECT_EQ(m.object.constraints.size(), groups);
    EXPECT_TRUE(m.object.joints.empty());
  };
  refused(BallJoint{.b = 7});
  refused(BallJoint{.a = b, .b = b});
  refused(BallJoint{.a = -1, .b = -1});
  refused(HingeJoint{.b = b, .axis = {0, 0, 0}});
  refused(HingeJoint{.b = b, .anchor = {NAN, 0, 0}});
  refused(HingeJoint{.b = b, .limit = JointRange{1, -1}});
  refused(HingeJoint{.b = b, .motor = JointMotor{.most = -1}});
  refused(HingeJoint{.b = b, .friction = -1});
  refused(UniversalJoint{.b = b, .axis_a = {1, 0, 0}, .axis_b = {1, 1, 0}});
  refused(SpringJoint{.b = b, .stiffness = 0});
  refused(GearJoint{.a = b, .b = -1});
  refused(SixAxisJoint{.b = b, .axes = {1, 1, 1, 1}});
  try {
    add_joint(m.object, HingeJoint{.b = b, .friction = -1, .options = {.name = "elbow"}});
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "object 'mechanism', joint 'elbow': has a friction of -1.000000; give a number of at least 0.000000");
  }
}

TEST(Joints, JointsAreListedWithTheirConstraints) {
  Mechanism m;
  const int b = m.box({0, 0, 0}), c = m.box({1, 0, 0});
  EXPECT_EQ(add_joint(m.object, HingeJoint{.b = b, .limit = JointRange{-1, 1}, .friction = 2}), 0);
  EXPECT_EQ(add_joint(m.object, HingeJoint{.a = b, .b = c, .options = {.name = "elbow"}}), 1);
  ASSERT_EQ(m.object.joints.size(), 2u);
  EXPECT_EQ(m.object.bodies.size(), 3u) << "the world is a body, added once";
  EXPECT_EQ(m.object.joints[0].name, "hinge 0");
  EXPECT_EQ(m.object.joints[1].name, "elbow");
  EXPECT_EQ(m.object.joints[0].constraints.size(), 3u);
  EXPECT_EQ(m.object.joints[1].constraints, (std::vector<std::array<int, 2>>{{0, 1}})) << "the second of its group";
  EXPECT_EQ(m.object.joints[0].a, 2);
}

}  // namespace
}  // namespace pliant
