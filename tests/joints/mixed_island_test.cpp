// A long chain with a heavy end whose joints are balls and hinges with limits, motors and friction, and which touches
// what is in its way.
#include <gtest/gtest.h>

#include <algorithm>

#include "joint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Links of 1 kg along x from the origin; of three joints one is a ball, one a hinge with a range, one a hinge with a
/// motor that resists, and friction.
struct MixedChain : Mechanism {
  std::vector<int> links;

  MixedChain(int count, float end_mass) {
    for (int i = 0; i < count; ++i) {
      const float x = half_link * static_cast<float>(2 * i + 1);
      links.push_back(box({x, 0, 0}, i + 1 == count ? end_mass : 1, {half_link, 0.05f, 0.05f}));
    }
    for (int i = 0; i < count; ++i) add_link_joint(i);
    substeps = 8;
  }

  Vec3f anchor(int i) const { return {half_link * static_cast<float>(2 * i), 0, 0}; }

  void add_link_joint(int i) {
    const int a = i == 0 ? -1 : links[static_cast<std::size_t>(i - 1)], b = links[static_cast<std::size_t>(i)];
    HingeJoint hinge{.a = a, .b = b, .anchor = anchor(i)};
    if (i % 3 == 1) hinge.limit = JointRange{-0.2f, 0.2f};
    if (i % 3 == 2)
      hinge.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 0, .most = 2}, hinge.friction = 0.5f;
    if (i % 3 == 0)
      add_joint(object, BallJoint{.a = a, .b = b, .anchor = anchor(i)});
    else
      add_joint(object, hinge);
  }

  /// A peg across the plane of the chain, and loose boxes on a shelf under it.
  void add_obstacles() {
    Collider peg;
    peg.name = "peg";
    peg.shape = Capsule{0.5f, 2};
    peg.position = {12, -6, 0};
    peg.rotation = convert<float>(Quatd{std::sqrt(0.5), 0, 0, std::sqrt(0.5)});  // along z
    scene.add(peg);
    Collider shelf;
    shelf.name = "shelf";
    shelf.shape = Box{{4, 0.2f, 1}};
    shelf.position = {30, -3, 0};
    scene.add(shelf);
    for (int k = 0; k < 8; ++k) box({27 + 0.8f * static_cast<float>(k), -2.5f, 0}, 1, {0.3f, 0.3f, 0.3f});
  }

  double drift() const {
    double most = length(place(links[0], {0, 0, 0}));
    for (std::size_t i = 1; i < links.size(); ++i) {
      const Vec3f at = anchor(static_cast<int>(i));
      most = std::max(most, length(place(links[i], at) - place(links[i - 1], at)));
    }
    return most;
  }

  void start_touching() {
    start();
    scene.objects[0].collides = scene.objects[0].self_collision = true;
    Settings settings = world->settings();
    world = std::make_unique<World>(scene, settings);
  }
};

/// Twice the drift that a chain of balls alone may have.
TEST(MixedIsland, ALongChainKeepsItsJointsAmongLimitsMotorsAndContacts) {
  MixedChain chain(100, 100);
  chain.add_obstacles();
  chain.start_touching();
  double drift = 0;
  std::size_t most_contacts = 0;
  for (int frame = 0; frame < 600; ++frame) {
    chain.run(1 / 60.);
    drift = std::max(drift, chain.drift());
    most_contacts = std::max(most_contacts, chain.world->state().body_contacts.size());
  }
  testing::Test::RecordProperty("drift", std::to_string(drift));
  EXPECT_LT(drift, 6e-5);
  EXPECT_GT(most_contacts, 8U);
}

}  // namespace
}  // namespace pliant
