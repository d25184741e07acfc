// Tests bodies that bounce without loss: none rises higher than it was let go from, in any number of bounces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// The highest place of a solid's centre in the last five of thirty seconds, let go from rest at a metre [m].
float highest_after_bounces(const SolidShape& shape, const Quatf& rotation, int substeps) {
  BodyOptions options;
  options.position = {0, 1, 0};
  options.rotation = rotation;
  Object object = make_body({{shape}}, options);
  object.restitution = 1;
  object.static_friction = object.kinetic_friction = 0;
  Scene scene;
  scene.colliders.emplace_back();
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(object);
  World world(scene);
  float highest = 0;
  for (int frame = 0; frame < 1800; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    if (frame >= 1500) highest = std::max(highest, world.object(0).positions()[0].y);
  }
  return highest;
}

/// A ball of restitution 1 keeps its height within what it falls in the last substep before it turns back.
TEST(BouncingBody, ABallKeepsItsHeight) {
  for (const int substeps : {4, 8, 32}) {
    const float height = highest_after_bounces(Sphere{0.1f}, {}, substeps);
    EXPECT_NEAR(height, 1, 0.02) << substeps << " substeps";
    EXPECT_LT(height, 1.005f) << substeps << " substeps";
  }
}

/// A rod that falls flat was thrown to 5.6 m.
TEST(BouncingBody, ARodThatFallsFlatRisesNoHigher) {
  const float half = std::sqrt(0.5f);
  EXPECT_LT(highest_after_bounces(Capsule{0.01f, 0.3f}, {0, 0, half, half}, 0), 1.02f);
}

/// Friction of an impact lets a ball leave rolling, with 3 (1 - 1 / (1 + 2.5 k^2)) of its 3 m/s, k r being the arm of friction: 15/7 at
/// its surface. Impacts are found up to half a frame's way ahead, between both surfaces, so k may be as much as 1.37.
TEST(BouncingBody, ABallBouncesWithFriction) {
  Scene scene;
  scene.add(Collider{});
  scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 0.2f;
  BodyOptions options;
  options.position = {0, 1, 0};
  options.velocity = {3, 0, 0};
  Object ball = make_body({{Sphere{0.1f}}}, options);
  ball.static_friction = ball.kinetic_friction = 0.2f;
  ball.restitution = 0.8f;
  scene.add(ball);
  World world(scene);
  for (int frame = 0; frame < 40; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_GT(world.object(0).velocities()[0].x, 2.13f);
  EXPECT_LT(world.object(0).velocities()[0].x, 2.47f);
  EXPECT_LT(world.state().frames.angular_velocities[0].z, -15);
}

/// A ball that hits another one off its middle sends it along the line of centres: sin = offset / diameter (20.9 degrees).
TEST(BouncingBody, ABallIsSentAlongTheLineOfCentres) {
  for (const float speed : {1.f, 2.f}) {
    Scene scene;
    scene.gravity = {0, 0, 0};
    Object balls;
    balls.restitution = 1;
    balls.static_friction = balls.kinetic_friction = 0;
    BodyOptions options;
    add_body(balls, {{Sphere{0.028f}}}, options);
    options.position = {-0.5f, 0, 0.02f};
    options.velocity = {speed, 0, 0};
    options.name = "cue";
    add_body(balls, {{Sphere{0.028f}}}, options);
    scene.add(balls);
    World world(scene);
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    const Vec3f v = world.object(0).velocities()[0];
    EXPECT_NEAR(std::atan2(-v.z, v.x) * 57.29578f, 20.9f, 1.5f)
        << speed;  // within 0.1 of the radius (far_moved) and a substep's way
  }
}

}  // namespace
}  // namespace pliant
