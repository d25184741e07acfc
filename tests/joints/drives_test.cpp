// What drives joints beside motors of a speed or position: springs on every axis, torques and forces, targets by
// keyframes.
#include <gtest/gtest.h>

#include <functional>

#include "joint_support.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float spring_stiffness = 20;  ///< [N/m or N m/rad]

/// A ball of 1 kg at the origin, so that each axis has the same inertia, free of gravity.
struct OneBody : Mechanism {
  OneBody() {
    scene.gravity = {};
    box({0, 0, 0}, 1, {0.3f, 0.3f, 0.3f});
  }
  static double inertia() { return box_inertia(1, 0.3, 0.3); }
  JointState state() const { return world->object(0).joint_state(0); }
};

/// rest (1 - cos(omega t)): springs keep their motion.
double swing(double rest, double omega, double t) { return rest * (1 - std::cos(omega * t)); }

/// The greatest deviation of a value from its swing in the first second, as a share of `rest`.
double deviation(OneBody& m, double rest, double omega, const std::function<double(const JointState&)>& value) {
  m.start();
  double worst = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    m.run(1 / 60.);
    worst = std::max(worst, std::abs(value(m.state()) - swing(rest, omega, frame / 60.)) / rest);
  }
  return worst;
}

const JointSpring test_spring{0.5f, spring_stiffness, 0};

TEST(JointSprings, SwingWithTheirPeriodOnEveryAxis) {
  const double omega_turn = std::sqrt(spring_stiffness / OneBody::inertia()),
               omega_slide = std::sqrt(double(spring_stiffness));
  constexpr double tolerated = 0.02;
  OneBody hinge, slider, cylinder;
  add_joint(hinge.object, HingeJoint{.b = 0, .axis = {0, 0, 1}, .spring = test_spring});
  EXPECT_LT(deviation(hinge, 0.5, omega_turn, [](const JointState& s) { return s.rotation.x; }), tolerated);
  add_joint(slider.object, SliderJoint{.b = 0, .axis = {0, 0, 1}, .spring = test_spring});
  EXPECT_LT(deviation(slider, 0.5, omega_slide, [](const JointState& s) { return s.displacement.x; }), tolerated);
  add_joint(cylinder.object,
            CylindricalJoint{.b = 0, .axis = {0, 1, 0}, .slide_spring = test_spring, .turn_spring = test_spring});
  EXPECT_LT(deviation(cylinder, 0.5, omega_slide, [](const JointState& s) { return s.displacement.x; }), tolerated);
  EXPECT_NEAR(cylinder.state().rotation.x, swing(0.5, omega_turn, 1), 0.01);
  OneBody universal, planar, six;
  add_joint(universal.object, UniversalJoint{.b = 0, .spring_b = test_spring});
  EXPECT_LT(deviation(universal, 0.5, omega_turn, [](const JointState& s) { return s.rotation.y; }), tolerated);
  add_joint(planar.object,
            PlanarJoint{.b = 0, .axis_x = Vec3f{1, 0, 0}, .y_spring = test_spring, .turn_spring = test_spring});
  EXPECT_LT(deviation(planar, 0.5, omega_slide, [](const JointState& s) { return s.displacement.z; }), tolerated);
  EXPECT_NEAR(planar.state().rotation.x, swing(0.5, omega_turn, 1), 0.01);
  SixAxisJoint joint{.b = 0};
  joint.linear[1] = {AxisFreedom::Kind::free, {}, {}, 0, test_spring};
  add_joint(six.object, joint);
  EXPECT_LT(deviation(six, 0.5, omega_slide, [](const JointState& s) { return s.displacement.y; }), tolerated);
}

TEST(JointSprings, DampersSlowThem) {
  OneBody m;
  const float critical = 2 * std::sqrt(spring_stiffness * static_cast<float>(OneBody::inertia()));
  add_joint(m.object, HingeJoint{.b = 0, .axis = {0, 0, 1}, .spring = JointSpring{0.5f, spring_stiffness, critical}});
  const double omega = std::sqrt(spring_stiffness / OneBody::inertia());
  m.start();
  for (int frame = 1; frame <= 60; ++frame) {
    m.run(1 / 60.);
    const double t = frame / 60.;
    EXPECT_NEAR(m.state().rotation.x, 0.5 * (1 - (1 + omega * t) * std::exp(-omega * t)), 0.01) << frame;
  }
}

TEST(JointTorques, AccelerateAndBear) {
  OneBody m;
  HingeJoint hinge{.b = 0, .axis = {0, 0, 1}};
  hinge.motor = JointMotor{.kind = JointMotor::Kind::torque, .target = -0.12f};
  hinge.options.name = "wheel";
  add_joint(m.object, hinge);
  m.run(0.5);
  EXPECT_NEAR(m.state().angular_velocity.x, -0.12 / OneBody::inertia() * 0.5, 2e-3);
  m.world->object(0).set_motor("wheel", {.target = 0.24f});
  m.run(0.5);
  EXPECT_NEAR(m.state().angular_velocity.x, 0.06 / OneBody::inertia(), 3e-3);
  m.world->object(0).set_motor("wheel", {.target = 0});
  const float before = m.state().angular_velocity.x;
  m.run(0.5);
  EXPECT_NEAR(m.state().angular_velocity.x, before, 1e-4);
  OneBody lift;
  lift.scene.gravity = {0, -9.81f, 0};
  SliderJoint slider{.b = 0, .axis = {0, 1, 0}};
  slider.motor = JointMotor{.kind = JointMotor::Kind::torque, .target = 10.81f};
  add_joint(lift.object, slider);
  lift.run(1);
  EXPECT_NEAR(lift.state().velocity.x, 1, 5e-3);
}

TEST(MotorKeyframes, AreFollowedAtTheEndOfEachFrame) {
  OneBody m;
  SliderJoint slider{.b = 0, .axis = {0, 1, 0}};
  slider.motor = JointMotor{.most = 1e5f, .keyframes = {{0, 0}, {1, 2}, {1.5f, 2}, {2, -1}}};
  slider.options.name = "lift";
  add_joint(m.object, slider);
  m.start();
  const auto wanted = [](double t) { return t < 1 ? 2 * t : t < 1.5 ? 2 : std::max(2 - 6 * (t - 1.5), -1.); };
  State middle;
  for (int frame = 1; frame <= 150; ++frame) {
    m.run(1 / 60.);
    ASSERT_NEAR(m.state().velocity.x, wanted(frame / 60.), 2e-3) << frame;
    if (frame == 40) middle = m.world->state();
  }
  const std::string end = m.world->state_hash();
  m.world->restore(middle);
  m.run(110 / 60.);
  EXPECT_EQ(m.world->state_hash(), end);
  m.world->restore(middle);
  m.world->object(0).set_motor("lift", {.target = 0.25f});
  m.run(0.5);
  EXPECT_NEAR(m.state().velocity.x, 0.25, 2e-3) << "a call replaces them";
  Scene same = m.scene;
  same.settings = m.world->settings();
  World again(same, m.world->layout());
  again.restore(m.world->state());
  m.run(0.5);
  for (int frame = 0; frame < 30; ++frame) again.step(1.f / 60);
  EXPECT_EQ(again.state_hash(), m.world->state_hash());
}

TEST(JointDrives, RefuseWhatIsWrong) {
  const auto refuses = [](const HingeJoint& hinge) {
    Mechanism m;
    m.box({0, 0, 0});
    EXPECT_THROW(add_joint(m.object, hinge), Error);
    EXPECT_TRUE(m.object.joints.empty());
  };
  refuses({.b = 0, .spring = JointSpring{0, 0, 0}});
  refuses({.b = 0, .spring = JointSpring{0, 1, -1}});
  refuses({.b = 0, .spring = JointSpring{std::nanf(""), 1, 0}});
  refuses({.b = 0, .motor = JointMotor{.keyframes = {{1, 0}, {1, 2}}}});
  refuses({.b = 0, .motor = JointMotor{.keyframes = {{1, std::nanf("")}}}});
  refuses({.b = 0, .motor = JointMotor{.kind = JointMotor::Kind::torque, .target = std::nanf("")}});
}

}  // namespace
}  // namespace pliant
