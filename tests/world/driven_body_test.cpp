// Tests bodies whose pins turn: they follow the pin with place and orientation, and carry what touches them or is
// jointed to them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "pliant/body.h"
#include "pliant/edit.h"
#include "pliant/joint.h"
#include "pliant/world.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::float_pi;
using testing_support::run;

/// Turns about the y-axis through a pivot by `speed` [rad/s] for some seconds.
Motion turning(float speed, int seconds, const Vec3f& pivot = {}) {
  Motion motion;
  motion.pivot = pivot;
  for (int i = 0; i <= 8 * seconds; ++i) {
    const float time = static_cast<float>(i) / 8, half = speed * time / 2;
    motion.keyframes.push_back({time, {}, {0, std::sin(half), 0, std::cos(half)}});
  }
  return motion;
}

Object body_at(const SolidShape& shape, const Vec3f& position) {
  BodyOptions options;
  options.position = position;
  Object body = make_body({{shape}}, options);
  body.static_friction = body.kinetic_friction = 1;
  return body;
}

Object driven(const SolidShape& shape, const Vec3f& position, const Motion& motion) {
  Object body = body_at(shape, position);
  body.pins.push_back({0, motion});
  return body;
}

/// The angle about y of a rotation about that axis [rad].
float angle_of(const Quatf& q) {
  EXPECT_NEAR(std::hypot(q.x, q.z), 0, 1e-3);
  return 2 * std::atan2(q.y, q.w);
}

TEST(DrivenBody, FollowsThePlaceAndTheRotationOfItsPin) {
  Scene scene;
  scene.add(driven(Box{{0.5f, 0.1f, 0.1f}}, {1, 0, 0}, turning(float_pi / 2, 1)));
  World world(scene);
  run(world, 30);
  const RigidPose half = world.object(0).pose(0);
  EXPECT_NEAR(angle_of(half.rotation), float_pi / 4, 1e-5);
  EXPECT_NEAR(half.position.x, std::cos(float_pi / 4), 1e-5);
  EXPECT_NEAR(half.position.z, -std::sin(float_pi / 4), 1e-5);
  run(world, 60);
  EXPECT_NEAR(angle_of(world.object(0).pose(0).rotation), float_pi / 2, 1e-5) << "it stays where its last keyframe is";
}

TEST(DrivenBody, WhoseMotionOnlyMovesIsFreeToTurn) {
  Scene scene;
  BodyOptions options;
  options.angular_velocity = {0, 1, 0};
  Object wheel = make_body({{Sphere{0.2f}}}, options);
  wheel.pins.push_back({0, {{{0}, {2, {0, 1, 0}}}}});
  scene.add(wheel);
  World world(scene);
  run(world, 60);
  EXPECT_NEAR(angle_of(world.object(0).pose(0).rotation), 1, 1e-3);
}

TEST(DrivenBody, CarriesRoundWhatLiesOnIt) {
  Scene scene;
  scene.add(driven(Box{{2, 0.1f, 2}}, {0, -0.1f, 0}, turning(float_pi / 4, 4)));
  scene.add(body_at(Box{{0.1f, 0.1f, 0.1f}}, {1, 0.1f, 0}));
  World world(scene);
  run(world, 240);
  const RigidPose rider = world.object(1).pose(0);
  EXPECT_NEAR(std::hypot(rider.position.x, rider.position.z), 1, 0.02) << "it starts from rest";
  EXPECT_NEAR(std::fabs(angle_of(rider.rotation)), float_pi, 0.2);
}

TEST(DrivenBody, PushesABallAtTheSpeedOfItsSurface) {
  Scene scene;
  scene.gravity = {};
  scene.add(driven(Box{{1, 0.1f, 0.05f}}, {1, 0, 0}, turning(2, 1)));
  Object ball = body_at(Sphere{0.1f}, {1.5f, 0, -0.25f});
  ball.static_friction = ball.kinetic_friction = 0;
  scene.add(ball);
  World world(scene);
  run(world, 12);
  const Vec3f v = world.object(1).velocities()[0];
  EXPECT_GT(std::hypot(v.x, v.z), 2 * 1.45f);
  EXPECT_LT(std::hypot(v.x, v.z), 2 * 1.7f);
}

TEST(DrivenBody, TakesAlongWhatIsJointedToIt) {
  Scene scene;
  Object arm = driven(Box{{0.5f, 0.05f, 0.05f}}, {0.5f, 0, 0}, turning(float_pi / 2, 2));
  const int hand = add_body(arm, {{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {1.1f, 0, 0}});
  add_joint(arm, FixedJoint{.a = 0, .b = hand, .anchor = {1, 0, 0}});
  scene.add(arm);
  World world(scene);
  run(world, 120);
  const RigidPose pose = world.object(0).pose(hand);
  EXPECT_NEAR(pose.position.x, -1.1, 2e-3);
  EXPECT_NEAR(pose.position.z, 0, 5e-3);
  EXPECT_NEAR(std::fabs(angle_of(pose.rotation)), float_pi, 5e-3);
}

TEST(DrivenBody, TurnsOnAfterARestoreWithTheSameBits) {
  Scene scene;
  scene.add(driven(Box{{2, 0.1f, 2}}, {0, -0.1f, 0}, turning(1, 4)));
  scene.add(body_at(Box{{0.1f, 0.1f, 0.1f}}, {1, 0.1f, 0}));
  World world(scene), other(scene);
  run(world, 20);
  other.restore(world.state());
  run(world, 20);
  run(other, 20);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

/// Its tip moves by 17 cm in the first frame, and the plate is 2 cm thick.
TEST(DrivenBody, DoesNotPassThroughAThinPlateInItsFirstFrame) {
  Scene scene;
  scene.gravity = {};
  scene.add(driven(Box{{0.5f, 0.1f, 0.01f}}, {0.5f, 0, 0}, turning(10, 1)));
  scene.add(body_at(Box{{0.05f, 0.1f, 0.01f}}, {0.9f, 0, -0.05f}));
  World world(scene);
  run(world, 3);
  const Vec3f v = world.object(1).velocities()[0];
  EXPECT_LT(v.z, -7) << "the paddle takes it along";
}

TEST(DrivenBody, StandsStillOnceItsPinIsGone) {
  Scene scene;
  BodyOptions options;
  options.mass = std::numeric_limits<float>::infinity();
  Object body = make_body({{Box{}}}, options);
  body.pins.push_back({0, turning(1, 4)});
  scene.add(body);
  World world(scene);
  run(world, 30);
  Edit edit = unchanged(scene.objects[0]);
  edit.object.pins.clear();
  world.edit(0, edit);
  const float angle = angle_of(world.object(0).pose(0).rotation);
  run(world, 30);
  EXPECT_EQ(angle_of(world.object(0).pose(0).rotation), angle);
}

TEST(DrivenBody, StartsWhereItsKeyframesAreIfItIsAddedLater) {
  Scene scene;
  scene.add(body_at(Sphere{0.1f}, {0, 5, 0}));
  World world(scene);
  run(world, 30);
  const ObjectId id = world.add(driven(Box{{0.5f, 0.1f, 0.1f}}, {1, 0, 0}, turning(float_pi / 2, 1)));
  EXPECT_NEAR(angle_of(world.object(id).pose(0).rotation), float_pi / 4, 1e-5);
}

}  // namespace
}  // namespace pliant
