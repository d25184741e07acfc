// What control reads of joints and contacts: angles and speeds, mean loads over a frame, and what each body touches.
#include <gtest/gtest.h>

#include "joint_support.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace testing_support;

JointState state_of(const Mechanism& m, int joint) { return m.world->object(0).joint_state(joint); }

TEST(JointStates, AHingeHasItsAngleAndSpeed) {
  Mechanism m;
  m.box({0.5f, 0, 0});
  HingeJoint hinge{.b = 0, .anchor = {0, 0, 0}, .axis = {0, 0, 2}};
  hinge.motor = JointMotor{.target = 1.5f, .most = 1e4f};
  hinge.options.name = "shoulder";
  add_joint(m.object, hinge);
  m.start();
  EXPECT_EQ(state_of(m, 0).rotation, Vec3f{});
  EXPECT_EQ(m.world->object(0).joint_index("shoulder"), 0);
  EXPECT_THROW((void)m.world->object(0).joint_index("elbow"), Error);
  EXPECT_THROW((void)m.world->object(0).joint_state(1), Error);
  m.run(1);
  EXPECT_NEAR(state_of(m, 0).rotation.x, 1.5, 2e-3);
  EXPECT_NEAR(state_of(m, 0).rotation.x, m.turned(0).z, 1e-6);
  EXPECT_NEAR(state_of(m, 0).angular_velocity.x, 1.5, 1e-3);
  EXPECT_NEAR(length(wide(state_of(m, 0).displacement)), 0, 1e-5);
  EXPECT_NEAR(length(wide(state_of(m, 0).velocity)), 0, 1e-3);
  m.run(1);  // beyond half a turn it counts from the other side
  EXPECT_NEAR(state_of(m, 0).rotation.x, 3, 4e-3);
  m.run(0.5);
  EXPECT_NEAR(state_of(m, 0).rotation.x, 3.75 - 2 * pi, 5e-3);
}

TEST(JointStates, AreSeenFromBodyA) {
  Mechanism m;
  m.scene.gravity = {};
  const Vec3f spin{0, 0.5f, 0};
  m.box({0, 0, 0}, 1, {0.5f, 0.1f, 0.1f}, {}, spin);
  m.box({2, 0, 0}, 1, {0.5f, 0.1f, 0.1f}, {0, 0, -1}, spin);  // moves with the first as one
  SliderJoint slider{.a = 0, .b = 1, .anchor = {1, 0, 0}, .axis = {1, 0, 0}};
  slider.motor = JointMotor{.target = 0.2f, .most = 1e4f};
  add_joint(m.object, slider);
  m.run(1);
  const JointState state = state_of(m, 0);
  EXPECT_NEAR(state.displacement.x, 0.2, 2e-3);
  EXPECT_NEAR(state.velocity.x, 0.2, 2e-3);
  EXPECT_NEAR(state.displacement.z, 0, 1e-4);
  EXPECT_NEAR(state.velocity.z, 0, 2e-3);
  EXPECT_NEAR(length(wide(state.angular_velocity)), 0, 2e-3);
  EXPECT_GT(std::abs(m.turned(0).y), 0.4) << "the pair turns in the world";
}

TEST(JointStates, RotationsAboutTheAxesOfTheJoint) {
  Mechanism m;
  m.scene.gravity = {};
  m.box({0, 0, 0}, 1, {0.5f, 0.1f, 0.1f}, {}, {0, 0, 0.5f});
  SixAxisJoint joint{.b = 0, .axes = Quatf{0, 0, 0.70710678f, 0.70710678f}};  // its x-axis is y
  for (AxisFreedom& axis : joint.angular) axis.kind = AxisFreedom::Kind::free;
  add_joint(m.object, joint);
  m.run(1);
  EXPECT_NEAR(state_of(m, 0).rotation.z, 0.5, 1e-3);
  EXPECT_NEAR(state_of(m, 0).rotation.x, 0, 1e-3);
  Mechanism other;
  other.scene.gravity = {};
  other.box({0, 0, 0}, 1, {0.1f, 0.5f, 0.1f}, {}, {0, 0.5f, 0});
  add_joint(other.object, joint);
  other.run(1);
  EXPECT_NEAR(state_of(other, 0).rotation.x, 0.5, 1e-3);
}

TEST(JointLoads, TheMeanIsTheWeight) {
  Mechanism m;
  m.substeps = 8;
  m.box({0, -0.5f, 0}, 3);
  add_joint(m.object, BallJoint{.b = 0});
  m.start();
  EXPECT_THROW((void)m.world->object(0).mean_joint_load(0), Error) << "they are not recorded";
  m.world->record_joint_loads(true);
  EXPECT_EQ(m.world->object(0).mean_joint_load(0).force, Vec3f{});
  for (int frame = 0; frame < 30; ++frame) {
    m.run(1 / 60.);
    if (frame >= 2) {
      EXPECT_NEAR(m.world->object(0).mean_joint_load(0).force.y, 3 * gravity, 0.01 * 3 * gravity) << frame;
    }
  }
  const State before = m.world->state();
  m.run(1 / 60.);
  const Vec3f once = m.world->object(0).mean_joint_load(0).force;
  m.world->restore(before);
  m.run(1 / 60.);
  EXPECT_NEAR(m.world->object(0).mean_joint_load(0).force.y, once.y, 1e-3 * std::abs(once.y)) << "not twice";
}

/// A shelf that a joint holds, a cloth on it, and a stone on the cloth. Chains and contacts of pressed cloth are solved
/// again after the joints, so a substep's load lacks what they push; the next one's has it.
TEST(JointLoads, TheMeanIsTheWeightUnderPressedCloth) {
  Scene scene;
  Object shelf, stone;
  add_body(shelf, {{Box{{0.4f, 0.02f, 0.4f}}}}, {.mass = 1.f});
  add_joint(shelf, FixedJoint{.b = 0});
  add_body(stone, {{Box{{0.1f, 0.05f, 0.1f}}}}, {.position = {0, 0.09f, 0}, .mass = 2.f});
  Object cloth = make_cloth(grid_mesh(21, 21, 0.6f, 0.6f), {.material = fabric("denim")});
  for (Vec3f& p : cloth.positions) p.y = 0.03f;
  for (Object* object : {&shelf, &stone, &cloth}) object->collides = true;
  cloth.thickness = 0.005f;
  double mass = 1 + 2;
  for (const float m : cloth.masses) mass += static_cast<double>(m);
  const ObjectId id = scene.add(shelf);
  scene.add(stone);
  scene.add(cloth);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(scene.frame_time).ok());
  world.record_joint_loads(true);
  double mean = 0;
  for (int frame = 0; frame < 40; ++frame) {
    world.step(scene.frame_time);
    mean += static_cast<double>(world.object(id).mean_joint_load(0).force.y) / 40;
  }
  EXPECT_NEAR(mean, mass * gravity, 0.01 * mass * gravity);
}

TEST(JointLoads, TheMeanOverATurnIsMassTimesChangeOfVelocity) {
  Mechanism m;
  m.scene.gravity = {};
  m.box({1, 0, 0}, 2, {0.1f, 0.1f, 0.1f}, {0, 3, 0}, {0, 0, 3});
  add_joint(m.object, HingeJoint{.b = 0, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
  m.start();
  m.world->record_joint_loads(true);
  for (int frame = 0; frame < 20; ++frame) {
    const Vec3d before = m.velocity(0);
    m.run(1 / 60.);
    const Vec3d wanted = (m.velocity(0) - before) * (2 * 60.);
    EXPECT_LT(length(wide(m.world->object(0).mean_joint_load(0).force) - wanted), 0.02 * 2 * 3 * 3) << frame;
  }
}

TEST(BodyTouches, SayWhatEachBodyBears) {
  Scene scene;
  Object pile;
  pile.name = "pile";
  for (int i = 0; i < 3; ++i) {
    BodyOptions options;
    options.name = "box " + std::to_string(i);
    options.position = {0, 0.2f + 0.4f * static_cast<float>(i), 0};
    options.mass = static_cast<float>(i + 1);
    add_body(pile, {{Box{{0.2f, 0.2f, 0.2f}}}}, options);
  }
  pile.thickness = 0;
  pile.self_collision = pile.collides = true;
  scene.add(pile);
  scene.add(Collider{});
  World world(scene);
  EXPECT_TRUE(world.body_touches().empty());
  for (int frame = 0; frame < 60; ++frame) world.step(1.f / 60);
  EXPECT_TRUE(world.body_touches().empty()) << "they are not recorded";
  world.record_contact_events(true);
  world.step(1.f / 60);
  ASSERT_EQ(world.body_touches().size(), 3u);
  for (const BodyTouch& touch : world.body_touches()) {
    const bool on_floor = touch.second.thing.kind == Thing::Kind::collider;
    EXPECT_EQ(touch.second.body, on_floor ? -1 : touch.first.body + 1);
    double above = 0;
    for (int i = on_floor ? 0 : touch.second.body; i < 3; ++i) above += (i + 1) * gravity;
    EXPECT_NEAR(touch.push.y * 60, on_floor ? above : -above, 0.02 * above) << touch.first.body;
    EXPECT_NEAR(touch.position.y, 0.4 * touch.first.body + (on_floor ? 0 : 0.4), 0.02);
    EXPECT_GE(touch.contacts, 1);
  }
  world.record_contact_events(false);
  EXPECT_TRUE(world.body_touches().empty());
}

}  // namespace
}  // namespace pliant
