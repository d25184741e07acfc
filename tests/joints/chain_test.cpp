// Tests of joints that are solved directly: long chains with heavy ends, and trees with limits and motors.
#include <gtest/gtest.h>
#include <limits>

#include "joint_support.h"
#include "pliant/edit.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Ball-jointed links of 1 kg along x from the origin.
void add_chain(Mechanism& m, int links, float end_mass) {
  for (int i = 0; i < links; ++i) {
    const float x = half_link * static_cast<float>(2 * i + 1);
    const int b = m.box({x, 0, 0}, i + 1 == links ? end_mass : 1, {half_link, 0.05f, 0.05f});
    add_joint(m.object, BallJoint{.a = b == 0 ? -1 : i == 1 ? 0 : b - 1, .b = b, .anchor = {x - half_link, 0, 0}});
  }
}

double drift(const Mechanism& m, int links) {
  double most = length(m.place(0, {0, 0, 0}));
  for (int i = 1; i < links; ++i) {
    const Vec3f anchor{half_link * static_cast<float>(2 * i), 0, 0};
    most = std::max(most, length(m.place(body_of_link(i), anchor) - m.place(body_of_link(i - 1), anchor)));
  }
  return most;
}

struct ChainResult {
  double drift = 0, gain = 0,
         end = 0;  ///< [m]; of energy, the largest and last, as shares of what all weight could gain
};

ChainResult run_chain(int links, float end_mass, int substeps, double seconds) {
  Mechanism m;
  m.substeps = substeps;
  add_chain(m, links, end_mass);
  m.start();
  const double scale = (links - 1 + double(end_mass)) * gravity * 0.5 * links, start = energy(m);
  ChainResult result;
  for (int frame = 0; frame < static_cast<int>(seconds * 60); ++frame) {
    m.run(1 / 60.);
    result.drift = std::max(result.drift, drift(m, links));
    result.end = (energy(m) - start) / scale;
    result.gain = std::max(result.gain, result.end);
  }
  testing::Test::RecordProperty("drift", std::to_string(result.drift));
  testing::Test::RecordProperty("gain", std::to_string(result.gain));
  testing::Test::RecordProperty("end", std::to_string(result.end));
  return result;
}

TEST(JointChains, AHeavyEndOnAHundredLinksKeepsJointsAndEnergy) {
  const ChainResult result = run_chain(100, 100, 8, 10);
  EXPECT_LT(result.drift, 3e-5);
  EXPECT_LT(result.gain, 1e-3);
  EXPECT_GT(result.end, -0.05);
}

// At less than 0.15 of the cost of 40 substeps of sweeps over the joints (`pliant bench joints`).
TEST(JointChains, TwoSubstepsKeepJointsAndGainNoEnergy) {
  for (const float end_mass : {100.f, 50000.f}) {
    const ChainResult result = run_chain(end_mass > 1000 ? 50 : 100, end_mass, 2, 10);
    EXPECT_LT(result.drift, 3e-5) << end_mass;
    EXPECT_LT(result.gain, 1e-3) << end_mass;
    EXPECT_GT(result.end, -0.1) << end_mass;
  }
}

TEST(JointChains, AnEndFiftyThousandTimesAsHeavyIsHeld) {
  const ChainResult result = run_chain(50, 50000, 8, 10);
  EXPECT_LT(result.drift, 5e-5);
  EXPECT_LT(result.gain, 1e-3);
}

TEST(JointChains, AUniformChainKeepsItsJoints) {
  const ChainResult result = run_chain(50, 1, 20, 5);
  EXPECT_LT(result.drift, 1e-4);
  EXPECT_LT(result.gain, 1e-3);
}

TEST(JointChains, ThreadsChangeNoBit) {
  std::string hashes[2];
  for (int i = 0; i < 2; ++i) {
    Mechanism m;
    m.threads = i == 0 ? 1 : 4;
    add_chain(m, 10, 5);
    m.run(1);
    hashes[i] = hash(m.world->state());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

/// A tree: an arm of three links whose first joint has a motor, the second a limit, and two fingers at its end.
TEST(JointChains, ATreeWithAMotorAndALimitKeepsItsJoints) {
  Mechanism m;
  m.substeps = 20;
  const auto hinge = [&](int a, int b, float x) {
    return HingeJoint{.a = a, .b = b, .anchor = {x, 0, 0}, .axis = {0, 0, 1}};
  };
  const int upper = m.box({0.25f, 0, 0}, 2, {0.25f, 0.05f, 0.05f}),
            lower = m.box({0.75f, 0, 0}, 1, {0.25f, 0.05f, 0.05f}),
            left = m.box({1.1f, 0, 0.1f}, 0.1f, {0.1f, 0.02f, 0.02f}),
            right = m.box({1.1f, 0, -0.1f}, 0.1f, {0.1f, 0.02f, 0.02f});
  HingeJoint shoulder = hinge(-1, upper, 0), elbow = hinge(upper, lower, 0.5f);
  shoulder.motor = JointMotor{.kind = JointMotor::Kind::position, .target = 0.5f, .most = 200};
  elbow.limit = JointRange{-1, 0.5f};
  add_joint(m.object, shoulder);
  add_joint(m.object, elbow);
  add_joint(m.object, hinge(lower, left, 1));
  add_joint(m.object, hinge(lower, right, 1));
  double gap = 0;
  for (int frame = 0; frame < 240; ++frame) {
    m.run(1 / 60.);
    gap = std::max(gap, length(m.place(upper, {0.5f, 0, 0}) - m.place(lower, {0.5f, 0, 0})));
    gap = std::max(gap, length(m.place(lower, {1, 0, 0.1f}) - m.place(left, {1, 0, 0.1f})));
    gap = std::max(gap, length(m.place(upper, {0, 0, 0})));
  }
  EXPECT_LT(gap, 1e-5);
  EXPECT_NEAR(m.turned(upper).z, 0.5, 0.02);
  EXPECT_NEAR(m.turned(lower).z, -0.5, 0.03) << "hangs at its limit";
}

// ---------------------------------------------------------------- loads and breaking

TEST(JointLoads, AFixedBoxIsCarriedByItsWeightAndItsMoment) {
  Mechanism m;
  const int b = m.box({1, 0, 0}, 5);
  add_joint(m.object, FixedJoint{.b = b, .anchor = {0, 0, 0}});
  m.run(1);
  const JointLoad load = m.world->object(0).joint_load(0);
  EXPECT_LT(length(wide(load.force) - Vec3d{0, 5 * gravity, 0}), 0.05);
  EXPECT_LT(length(wide(load.torque) - Vec3d{0, 0, 5 * gravity}), 0.1);
}

TEST(JointLoads, ASpringAndARopeCarryTheirWeights) {
  Mechanism m;
  const int spring = m.box({0, -1, 0}, 2), rope = m.box({5, -1, 0}, 3);
  add_joint(m.object, SpringJoint{.b = spring, .anchor_b = {0, -1, 0}, .stiffness = 500, .damping = 60});
  add_joint(m.object, DistanceJoint{.b = rope, .anchor_a = {5, 0, 0}, .anchor_b = {5, -1, 0}, .most = 1.f});
  m.run(4);
  EXPECT_NEAR(m.world->object(0).joint_load(0).force.y, 2 * gravity, 0.1);
  EXPECT_NEAR(m.world->object(0).joint_load(1).force.y, 3 * gravity, 1) << "rounding of a position over h^2";
  EXPECT_THROW((void)m.world->object(0).joint_load(2), std::exception);
}

/// A box whose joint carries 5 g and, 1 m from its centre, 5 g N m.
Mechanism bracket(const JointOptions& options) {
  Mechanism m;
  const int b = m.box({1, 0, 0}, 5);
  add_joint(m.object, FixedJoint{.b = b, .anchor = {0, 0, 0}, .options = options});
  m.start();
  return m;
}

TEST(JointBreaks, AJointBreaksByForceOrTorqueAboveItsLimitAlone) {
  const float load = 5 * 9.81f;
  EXPECT_EQ(bracket({.break_force = 1.1f * load}).world->step(frame_time).broken_joints.size(), 0u);
  EXPECT_EQ(bracket({.break_torque = 1.1f * load}).world->step(frame_time).broken_joints.size(), 0u);
  EXPECT_EQ(bracket({.break_force = 0.9f * load}).world->step(frame_time).broken_joints.size(), 1u);
  Mechanism m = bracket({.name = "bracket", .break_torque = 0.9f * load});
  const Report report = m.world->step(frame_time);
  ASSERT_EQ(report.broken_joints.size(), 1u);
  EXPECT_EQ(report.broken_joints[0].name, "bracket");
  EXPECT_EQ(report.broken_joints[0].joint, 0);
  EXPECT_TRUE(m.world->object(0).joint_is_broken(0));
  EXPECT_EQ(m.world->object(0).joint_load(0).force, Vec3f{});
  m.run(1);
  EXPECT_LT(m.pose(0).position.y, -4) << "it falls";
  EXPECT_TRUE(m.world->step(frame_time).broken_joints.empty()) << "it breaks once";
}

/// A box that stands on a fixed one and is held by a joint that breaks as it is pressed down.
Scene standing_box(int joints) {
  Scene scene;
  Object pair;
  pair.name = "pair";
  add_body(pair, {{Box{{0.2f, 0.2f, 0.2f}}}}, {.mass = std::numeric_limits<float>::infinity()});
  add_body(pair, {{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {0, 0.301f, 0}, .mass = 1});
  for (int i = 0; i < joints; ++i)
    add_joint(pair, FixedJoint{.a = 0, .b = 1, .options = {.break_force = i == 0 ? 5.f : 1e6f}});
  scene.add(pair);
  return scene;
}

TEST(JointBreaks, ThenTheBodiesCollide) {
  World world(standing_box(1)), other(standing_box(1));
  EXPECT_EQ(world.step(frame_time).broken_joints.size(), 1u);
  other.restore(world.state());
  for (int frame = 0; frame < 240; ++frame) {
    EXPECT_TRUE(world.step(frame_time).ok());
    EXPECT_TRUE(other.step(frame_time).ok());
  }
  EXPECT_NEAR(world.object(0).positions()[1].y, 0.3, 2e-3) << "it stands";
  EXPECT_EQ(hash(world.state()), hash(other.state()));
}

TEST(JointBreaks, AnEditLeavesThemBroken) {
  Scene scene = standing_box(1);
  scene.objects[0].positions[1].y = 5;
  World world(scene);
  EXPECT_EQ(world.step(frame_time).broken_joints.size(), 1u);
  for (int frame = 0; frame < 30; ++frame) world.step(frame_time);
  const float before = world.object(0).positions()[1].y;
  world.edit({0}, unchanged(scene.objects[0]));
  EXPECT_TRUE(world.object(0).joint_is_broken(0));
  EXPECT_TRUE(world.step(frame_time).broken_joints.empty());
  EXPECT_LT(world.object(0).positions()[1].y, before) << "it falls on";
}

TEST(JointBreaks, ABrokenJointIsPartOfTheState) {
  Mechanism m = bracket({.break_force = 10}), other = bracket({.break_force = 10});
  m.run(0.1);
  ASSERT_EQ(m.world->state().broken_joints, (std::vector<BrokenJoint>{{0, 0}}));
  other.world->restore(m.world->state());
  EXPECT_TRUE(other.world->object(0).joint_is_broken(0));
  m.run(0.5);
  other.run(0.5);
  EXPECT_EQ(hash(m.world->state()), hash(other.world->state()));
  State wrong = m.world->state();
  wrong.broken_joints = {{0, 5}};
  EXPECT_THROW(other.world->restore(wrong), std::exception);
}

}  // namespace
}  // namespace pliant
