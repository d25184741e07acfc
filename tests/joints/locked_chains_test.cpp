// Tests chains whose joints hold angles, by themselves, at stops or by friction: they neither gain energy nor burst. In
// single precision they did, since the smallest eigenvalues of such a chain fall with the fourth power of its length.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "joint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Links of a chain along x from the origin: masses [kg], and half of the length of each [m].
struct Links {
  std::vector<float> masses;
  float half = 0.1f;
  std::function<void(Object&, int a, int b, const Vec3f& anchor)> join;
};

Mechanism chain(const Links& links) {
  Mechanism m;
  m.substeps = 8;
  for (int i = 0; i < static_cast<int>(links.masses.size()); ++i) {
    const float x = links.half * static_cast<float>(2 * i + 1);
    const int b = m.box({x, 0, 0}, links.masses[static_cast<std::size_t>(i)], {links.half, 0.03f, 0.03f});
    links.join(m.object, i == 0 ? -1 : body_of_link(i - 1), b, {x - links.half, 0, 0});
  }
  return m;
}

/// How far the energy rises above an earlier minimum, over the largest drop of the potential.
double largest_rise(Mechanism& m, int frames) {
  m.start();
  double least = energy(m), rise = 0, drop = 1e-3;
  const double start = m.world->measure().potential_energy();
  for (int frame = 0; frame < frames; ++frame) {
    m.run(1 / 60.);
    if (testing::Test::HasFatalFailure()) return INFINITY;
    rise = std::max(rise, energy(m) - least);
    least = std::min(least, energy(m));
    drop = std::max(drop, start - m.world->measure().potential_energy());
  }
  return rise / drop;
}

void hinge(Object& object, int a, int b, const Vec3f& anchor) {
  add_joint(object, HingeJoint{.a = a, .b = b, .anchor = anchor, .axis = {0, 0, 1}});
}

TEST(LockedChains, AHundredHingesSwing) {
  for (const int links : {55, 100, 200}) {
    Mechanism m = chain({std::vector<float>(static_cast<std::size_t>(links), 1), 0.1f, &hinge});
    EXPECT_LT(largest_rise(m, 240), 2e-3) << links;
  }
}

TEST(LockedChains, AHundredFixedJointsStandOut) {
  Mechanism m = chain({std::vector<float>(100, 0.72f), 0.1f, [](Object& object, int a, int b, const Vec3f& anchor) {
                         add_joint(object, FixedJoint{.a = a, .b = b, .anchor = anchor});
                       }});
  m.run(6);
  EXPECT_LT(length(m.place(body_of_link(99), {20, 0, 0}) - Vec3d{20, 0, 0}), 1e-3);
}

void hinge_with_stops(Object& object, int a, int b, const Vec3f& anchor) {
  add_joint(object,
            HingeJoint{.a = a, .b = b, .anchor = anchor, .axis = {0, 0, 1}, .limit = JointRange{-0.5236f, 0.5236f}});
}

TEST(LockedChains, StopsGiveNoEnergyToHeavyEnds) {
  for (const float end : {1.f, 50.f, 1000.f}) {
    Mechanism m = chain({{1, end}, 0.1f, &hinge_with_stops});
    EXPECT_LT(largest_rise(m, 300), 1e-2) << end;
  }
  for (const int links : {8, 15, 20}) {
    Mechanism m = chain({std::vector<float>(static_cast<std::size_t>(links), 1), 0.1f, &hinge_with_stops});
    EXPECT_LT(largest_rise(m, 300), 1e-2) << links;
  }
}

TEST(LockedChains, LimitsOfSwingGiveNoEnergy) {
  Mechanism m = chain({std::vector<float>(20, 1), 0.1f, [](Object& object, int a, int b, const Vec3f& anchor) {
                         add_joint(object, BallJoint{.a = a, .b = b, .anchor = anchor, .most_swing = 0.349f});
                       }});
  EXPECT_LT(largest_rise(m, 300), 1e-2);
}

TEST(LockedChains, FrictionHoldsThem) {
  Mechanism m =
      chain({std::vector<float>(8, 0.02f), 0.05f, [](Object& object, int a, int b, const Vec3f& anchor) {
               add_joint(object, HingeJoint{.a = a, .b = b, .anchor = anchor, .axis = {0, 0, 1}, .friction = 100});
             }});
  m.run(3);
  EXPECT_LT(length(m.place(body_of_link(7), {0.8f, 0, 0}) - Vec3d{0.8, 0, 0}), 1e-3);
}

TEST(LockedChains, StrongMotorsBendAnArm) {
  JointMotor motor{.target = 0.349f, .most = 1000, .rate = 20};
  motor.kind = JointMotor::Kind::position;
  Mechanism m =
      chain({std::vector<float>(12, 0.72f), 0.1f, [&](Object& object, int a, int b, const Vec3f& anchor) {
               add_joint(object, HingeJoint{.a = a, .b = b, .anchor = anchor, .axis = {0, 1, 0}, .motor = motor});
             }});
  m.run(4);
  EXPECT_NEAR(length(m.turned(body_of_link(11)) - Vec3d{0, 12 * 0.349 - 2 * pi, 0}), 0, 0.05);
}

/// A joint that begins far outside of its range goes back slowly.
TEST(Stops, BringBackWhatBeginsBeyondThem) {
  Mechanism m;
  const int b = m.box({0.5f, 0, 0});
  m.scene.gravity = {};
  add_joint(m.object, SliderJoint{.b = b, .limit = JointRange{0.5f, 5.5f}});
  m.start();
  for (int frame = 0; frame < 60; ++frame) {
    m.run(1 / 60.);
    EXPECT_LT(m.place(b, {0, 0, 0}).x, 1.01 * (frame + 1) / 60);  // not at the other stop within a frame
  }
  EXPECT_GT(m.place(b, {0, 0, 0}).x, 0.499);
}

}  // namespace
}  // namespace pliant
