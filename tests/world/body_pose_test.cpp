// Tests the poses of bodies that a World reports.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::refusal;

void expect_near(const RigidPose& pose, const RigidPose& wanted, double tolerance) {
  EXPECT_NEAR(pose.position.x, wanted.position.x, tolerance);
  EXPECT_NEAR(pose.position.y, wanted.position.y, tolerance);
  EXPECT_NEAR(pose.position.z, wanted.position.z, tolerance);
  const Quatf &p = pose.rotation, &q = wanted.rotation;
  EXPECT_NEAR(std::fabs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w), 1, tolerance);
}

/// Boxes whose frames are neither at their centres nor along their principal axes.
Object two_bodies() {
  BodyOptions options;
  options.name = "near";
  options.position = {1, 2, 3};
  options.rotation = rotation({0.6f, 0, 0.8f}, 40);
  Object object = make_body({{Box{{0.1f, 0.2f, 0.3f}}, {0.5f, 0, 0}}, {Sphere{0.1f}, {0, 0.4f, 0}}}, options);
  options.name = "far";
  options.position = {7, 2, 3};
  add_body(object, {{Box{{0.1f, 0.2f, 0.3f}}, {0.5f, 0, 0}}, {Sphere{0.1f}, {0, 0.4f, 0}}}, options);
  return object;
}

TEST(BodyPose, AtTheStartIsThatOfTheDescription) {
  const Object object = two_bodies();
  Scene scene;
  scene.add(object);
  const World world(scene);
  expect_near(world.object(0).pose(0), {{1, 2, 3}, rotation({0.6f, 0, 0.8f}, 40)}, 1e-6);
  expect_near(world.object(0).pose(1), pose_of(object, 1), 1e-6);
  expect_near(world.object(0).pose("far"), pose_of(object, 1), 1e-6);
}

/// A free body turns about its centre of mass: after t its frame is at c + v t - R(w t) a.
TEST(BodyPose, OfAFreeBodyTurnsAboutItsCentre) {
  BodyOptions options;
  options.position = {1, 0, 0};
  options.velocity = {0.5f, 0.25f, 0};
  options.angular_velocity = {0, 0, 1};
  const Vec3f arm{0.3f, 0, 0};
  Scene scene;
  scene.gravity = {};
  scene.add(make_body({{Box{{0.1f, 0.2f, 0.3f}}, arm}}, options));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const float c = std::cos(1.f), s = std::sin(1.f);
  const Vec3f centre = options.position + arm + options.velocity;
  expect_near(world.object(0).pose(0), {centre - Vec3f{c * arm.x, s * arm.x, 0}, rotation({0, 0, 1}, 57.29578f)}, 1e-4);
}

TEST(BodyPose, OfWhatDoesNotExistIsRefused) {
  Object object = two_bodies();
  object.name = "pair";
  object.bodies[0].name = object.bodies[1].name = "body";  // the default, which both may have
  Scene scene;
  scene.add(object);
  const World world(scene);
  EXPECT_NE(refusal([&] { (void)world.object(0).pose(2); }).find("object 'pair', body 2: does not exist"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)world.object(0).pose(-1); }).find("body -1"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)world.object(0).pose("wing"); }).find("body 'wing': does not exist"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)world.object(0).pose("body"); }).find("is the name of 2 bodies"), std::string::npos);
}

}  // namespace
}  // namespace pliant
