// Tests of what is changed while a World runs: targets of motors, and edits of objects with bodies.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "joint_support.h"
#include "pliant/edit.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float upper_length = 1, lower_length = 0.8f;

/// An arm of two links in the plane of x and y, with a motor in each joint; it starts along x.
struct Arm : Mechanism {
  int upper, lower;

  Arm() {
    upper = box({upper_length / 2, 0, 0}, 2, {upper_length / 2, 0.05f, 0.05f});
    lower = box({upper_length + lower_length / 2, 0, 0}, 1, {lower_length / 2, 0.05f, 0.05f});
    const JointMotor servo{.kind = JointMotor::Kind::position, .target = 0, .most = 400, .rate = 30};
    add_joint(object, HingeJoint{.b = upper, .motor = servo, .options = {.name = "shoulder"}});
    add_joint(
        object,
        HingeJoint{
            .a = upper, .b = lower, .anchor = {upper_length, 0, 0}, .motor = servo, .options = {.name = "elbow"}});
    start();
  }
  Vec3d tip() const { return place(lower, {upper_length + lower_length, 0, 0}); }
};

/// The angles of shoulder and elbow at which the tip of an arm is at a point: two sides of a triangle.
std::array<double, 2> angles_for(const Vec3d& at) {
  const double a = double(upper_length), b = double(lower_length), reach2 = at.x * at.x + at.y * at.y;
  const double elbow = std::acos((reach2 - a * a - b * b) / (2 * a * b));
  const double shoulder = std::atan2(at.y, at.x) - std::atan2(b * std::sin(elbow), a + b * std::cos(elbow));
  return {shoulder, elbow};
}

/// Where the tip shall be: on a circle, reached from the outstretched arm in the first second.
Vec3d course(double time) {
  const double share = std::min(time, 1.0), angle = 2 * pi * 0.25 * std::max(time - 1, 0.0);
  const Vec3d first{1.5, 0, 0};
  return time < 1 ? Vec3d{1.8, 0, 0} * (1 - share) + first * share
                  : Vec3d{1.2 + 0.3 * std::cos(angle), 0.3 * std::sin(angle), 0};
}

void command(Arm& arm, double time) {
  const auto [shoulder, elbow] = angles_for(course(time));
  arm.world->object(0).set_motor("shoulder", {.target = static_cast<float>(shoulder)});
  arm.world->object(0).set_motor("elbow", {.target = static_cast<float>(elbow)});
}

TEST(MotorCommands, AnArmFollowsACircle) {
  Arm arm;
  for (int frame = 0; frame < 300; ++frame) {
    const double time = frame / 60.;
    command(arm, time);
    arm.run(1 / 60.);
    // A position motor follows a moving target with a lag of one over its rate; a frame is between command and
    // comparison.
    const double late = 1 / 30. + 1 / 60.;
    if (time < 1.5) continue;
    EXPECT_LT(length(arm.tip() - course(time + 1 / 60. - late)), 0.01) << time;
  }
}

TEST(MotorCommands, AnArmThatIsGivenOnePlaceComesToRestThere) {
  Arm arm;
  const Vec3d place{0.9, 0.8, 0};
  const auto [shoulder, elbow] = angles_for(place);
  arm.world->object(0).set_motor("shoulder", {.target = static_cast<float>(shoulder)});
  arm.world->object(0).set_motor("elbow", {.target = static_cast<float>(elbow - 6 * pi)});  // modulo full turns
  arm.run(2);
  EXPECT_LT(length(arm.tip() - place), 1e-3) << "it keeps the target over frames";
}

TEST(MotorCommands, AGreatestTorqueLetsGo) {
  Arm arm;
  arm.world->object(0).set_motor("shoulder", {.target = 0, .most = 1.f});
  arm.run(0.5);
  EXPECT_LT(arm.turned(arm.upper).z, -0.5);
}

TEST(MotorCommands, ASpeedMotorTakesASpeed) {
  Mechanism m;
  const int b = m.box({0, 0, 0});
  HingeJoint joint{.b = b, .motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 1, .most = 100}};
  add_joint(m.object, joint);
  m.run(0.5);
  EXPECT_NEAR(m.spin(b).z, 1, 1e-3);
  m.world->object(0).set_motor("hinge 0", {.target = -7});
  m.run(0.5);
  EXPECT_NEAR(m.spin(b).z, -7, 1e-2);
}

TEST(MotorCommands, OneOfSeveralMotorsIsChosenByItsName) {
  Mechanism m;
  m.scene.gravity = {};
  const int b = m.box({0, 0, 0});
  const JointMotor still{.kind = JointMotor::Kind::position, .most = 100};
  add_joint(m.object, UniversalJoint{.b = b, .motor_a = still, .motor_b = still, .options = {.name = "neck"}});
  m.start();
  m.world->object(0).set_motor("neck", {.target = 0.5f, .motor = "motor_b"});
  m.run(2);
  EXPECT_LT(length(m.turned(b) - Vec3d{0, 0.5, 0}), 1e-3);
}

TEST(MotorCommands, TargetsArePartOfTheState) {
  Arm arm;
  command(arm, 0.9);
  arm.run(0.1);
  const State state = arm.world->state();
  ASSERT_EQ(state.motors.size(), 2U);
  const auto end_of = [&](World& world) {
    for (int frame = 0; frame < 10; ++frame) world.step(frame_time);
    return world.state_hash();
  };
  const std::string known = end_of(*arm.world);

  Arm same;
  same.world->object(0).set_motor("elbow", {.target = 1.5f, .most = 3.f});  // restore() takes it back
  same.world->restore(state);
  EXPECT_EQ(end_of(*same.world), known);
  same.world->restore(arm.world->state());
  EXPECT_EQ(same.world->state_hash(), known);

  State without = state;
  without.motors.clear();
  same.world->restore(without);
  EXPECT_NE(end_of(*same.world), known) << "the targets of the description";
  EXPECT_NE(hash(without), hash(state));
}

TEST(MotorCommands, WrongStatesAreRefused) {
  Arm arm;
  command(arm, 0.9);
  const State state = arm.world->state();
  const auto refused = [&](const std::function<void(std::vector<MotorSetting>&)>& change) {
    State wrong = state;
    change(wrong.motors);
    EXPECT_THROW(arm.world->restore(wrong), Error);
  };
  refused([](auto& motors) { motors[0].joint = 7; });
  refused([](auto& motors) { motors[1].motor = 1; });
  refused([](auto& motors) { motors[1].block = -1; });
  refused([](auto& motors) { std::swap(motors[0], motors[1]); });
  refused([](auto& motors) { motors[0].target = NAN; });
  refused([](auto& motors) { motors[0].most = 0; });
  EXPECT_NO_THROW(arm.world->restore(state));
}

TEST(MotorCommands, WrongOnesAreNamed) {
  Mechanism m;
  const int b = m.box({0, 0, 0}), c = m.box({1, 0, 0});
  add_joint(m.object, HingeJoint{.b = b, .friction = 1, .options = {.name = "plain"}});
  add_joint(m.object,
            CylindricalJoint{
                .a = b, .b = c, .slide_motor = JointMotor{}, .turn_motor = JointMotor{}, .options = {.name = "two"}});
  m.start();
  const auto refusal = [&](const std::string& joint, const MotorCommand& command) {
    try {
      m.world->object(0).set_motor(joint, command);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("nose", {}), "object 'mechanism', joint 'nose': does not exist; name one of 'plain', 'two'");
  EXPECT_EQ(refusal("plain", {}),
            "object 'mechanism', joint 'plain': has no motor; describe one when you add the joint");
  EXPECT_EQ(refusal("two", {}),
            "object 'mechanism', joint 'two': has several motors; name one of 'slide_motor', 'turn_motor'");
  EXPECT_EQ(refusal("two", {.motor = "motor"}),
            "object 'mechanism', joint 'two': has no motor 'motor'; name one of 'slide_motor', 'turn_motor'");
  EXPECT_EQ(refusal("two", {.target = NAN, .motor = "turn_motor"}),
            "object 'mechanism', motor 'turn_motor' of joint 'two': its target is not finite; give a finite number");
  EXPECT_EQ(refusal("two", {.most = 0.f, .motor = "turn_motor"}),
            "object 'mechanism', motor 'turn_motor' of joint 'two': its greatest torque or force is 0.000000; give a "
            "number above 0");
  EXPECT_TRUE(m.world->state().motors.empty());
  EXPECT_EQ(refusal("two", {.motor = "turn_motor"}), "");
}

// ---------------------------------------------------------------- edits

/// Removes the first of three bodies, which spin differently: the others keep their orientations and angular
/// velocities.
TEST(BodyEdits, BodiesAfterARemovedOneKeepTheirOrientations) {
  Mechanism m;
  m.scene.gravity = {};
  for (int i = 0; i < 3; ++i)
    m.box({2.f * static_cast<float>(i), 0, 0}, 1, {0.2f, 0.2f, 0.2f}, {}, {0, 0, 1.f + static_cast<float>(i)});
  m.run(0.5);
  const std::vector<Quatf> turned = m.world->object(0).orientations();
  const std::vector<Vec3f> spins = m.world->object(0).angular_velocities();

  Edit edit = unchanged(m.object);
  Object& object = edit.object;
  object.positions.erase(object.positions.begin());
  object.masses.erase(object.masses.begin());
  if (!object.velocities.empty()) object.velocities.erase(object.velocities.begin());
  object.frames.erase(object.frames.begin());
  object.bodies.erase(object.bodies.begin());
  for (ObjectBody& body : object.bodies) --body.particle, --body.frame;
  edit.from = {1, 2};
  m.world->edit(0, edit);
  const ObjectView after = m.world->object(0);
  ASSERT_EQ(after.orientations().size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after.orientations()[i].z, turned[i + 1].z) << i;
    EXPECT_EQ(after.angular_velocities()[i], spins[i + 1]) << i;
    EXPECT_EQ(after.positions()[i], object.positions[i]) << i;
  }
}

/// A new body before the others has its own orientation and spin.
TEST(BodyEdits, ANewBodyStartsAsDescribed) {
  Mechanism m;
  m.scene.gravity = {};
  m.box({0, 0, 0}, 1, {0.2f, 0.2f, 0.2f}, {}, {0, 0, 2});
  m.run(0.5);
  const Quatf turned = m.world->object(0).orientations()[0];
  Mechanism with;
  with.object.name = m.object.name;
  with.box({5, 0, 0}, 1, {0.2f, 0.2f, 0.2f}, {}, {0, 0, -1});
  with.box({0, 0, 0}, 1, {0.2f, 0.2f, 0.2f});
  with.object.collides = with.object.self_collision = false;
  m.world->edit(0, {with.object, {-1, 0}});
  const ObjectView after = m.world->object(0);
  EXPECT_EQ(after.orientations()[0], Quatf{});
  EXPECT_EQ(after.angular_velocities()[0], (Vec3f{0, 0, -1}));
  EXPECT_EQ(after.orientations()[1].z, turned.z);
  EXPECT_NEAR(after.angular_velocities()[1].z, 2, 1e-4);
}

TEST(BodyEdits, AnEditReturnsMotorsToTheirDescription) {
  Arm arm;
  command(arm, 0.9);
  Edit edit = unchanged(arm.object);
  arm.world->edit(0, edit);
  EXPECT_TRUE(arm.world->state().motors.empty());
  arm.run(1);
  EXPECT_NEAR(arm.tip().x, double(upper_length + lower_length), 5e-3);
}

}  // namespace
}  // namespace pliant
