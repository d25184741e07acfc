// Tests boxes, hulls and plates on large spheres and capsules: they stay where friction holds them, and never sink in.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/world.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::run;

/// A solid whose lower face lies on a ball of radius `radius` about the origin, `angle` from the top.
struct Lying {
  SolidShape solid = Box{{0.02f, 0.02f, 0.02f}};
  float height = 0.02f;  ///< of the centre over the face
  float radius = 1, angle = 0.3f, friction = 0.8f;
  Vec3f velocity{}, spin{};
};

Scene lying_scene(const Lying& lying) {
  BodyOptions options;
  options.position = Vec3f{std::sin(lying.angle), std::cos(lying.angle), 0} * (lying.radius + lying.height);
  options.rotation = {0, 0, std::sin(-lying.angle / 2), std::cos(lying.angle / 2)};
  options.velocity = lying.velocity;
  options.angular_velocity = lying.spin;
  Scene scene;
  Object object = make_body({{lying.solid}}, options);
  object.static_friction = object.kinetic_friction = lying.friction;
  scene.add(object);
  return scene;
}

Scene on_collider(const Lying& lying, Collider collider) {
  Scene scene = lying_scene(lying);
  collider.static_friction = collider.kinetic_friction = lying.friction;
  scene.add(collider);
  return scene;
}

Collider ball(float radius) {
  Collider collider;
  collider.shape = Sphere{radius};
  return collider;
}

/// How far the first body has moved after two seconds [m].
float moved(const Scene& scene, float step = dt) {
  World world(scene);
  const Vec3f before = world.object(0).positions()[0];
  for (int frame = 0; static_cast<float>(frame) * step < 2; ++frame) EXPECT_TRUE(world.step(step).ok());
  return length(world.object(0).positions()[0] - before);
}

TEST(BoxOnRound, ABoxStaysOnALargeBall) {
  for (const float angle : {0.1f, 0.3f, -0.3f, 0.5f})
    for (const float radius : {0.5f, 1.f, 3.f, 30.f}) {
      Lying lying;
      lying.angle = angle;
      lying.radius = radius;
      EXPECT_LT(moved(on_collider(lying, ball(radius))), 2e-4f) << angle << " rad, " << radius << " m";
    }
}

TEST(BoxOnRound, SoDoPlatesHullsAndCylinders) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({(i & 1) != 0 ? 0.02f : -0.02f, (i & 2) != 0 ? 0.02f : -0.02f, (i & 4) != 0 ? 0.02f : -0.02f});
  const SolidShape shapes[] = {Box{{0.06f, 0.02f, 0.06f}}, Box{{0.1f, 0.02f, 0.02f}}, Hull{corners},
                               Cylinder{0.02f, 0.02f}};
  for (const SolidShape& shape : shapes) {
    Lying lying;
    lying.solid = shape;
    EXPECT_LT(moved(on_collider(lying, ball(1))), 3e-4f) << shape.index();
  }
}

TEST(BoxOnRound, NumbersOfSubstepsAndFramesDoNotMatter) {
  Scene scene = on_collider({}, ball(1));
  for (const float step : {1.f / 24, 1.f / 30, 1.f / 240}) EXPECT_LT(moved(scene, step), 5e-4f) << step;
  scene.settings.substeps = 40;
  EXPECT_LT(moved(scene), 1e-4f);
}

TEST(BoxOnRound, ACapsuleBearsABoxAtItsSide) {
  Collider capsule;
  capsule.shape = Capsule{1, 2};
  capsule.rotation = {std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)};
  EXPECT_LT(moved(on_collider({}, capsule)), 2e-4f);
}

/// A scene with a body of one solid in the origin, fixed or not, under what lies there.
Scene on_body(const SolidShape& solid, const BodyOptions& options) {
  Scene scene = lying_scene({});
  Object object = make_body({{solid}}, options);
  object.static_friction = object.kinetic_friction = 0.8f;
  scene.add(object);
  return scene;
}

TEST(BoxOnRound, AFixedBodyBearsABox) {
  BodyOptions options;
  options.mass = INFINITY;
  EXPECT_LT(moved(on_body(Sphere{1}, options)), 2e-4f);
  options.rotation = {std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)};
  EXPECT_LT(moved(on_body(Cylinder{1, 0.5f}, options)), 2e-4f);
  Scene at_the_end = on_body(Cylinder{1, 0.5f}, options);
  for (Vec3f& p : at_the_end.objects[0].positions) p.z = 0.495f;  // 5 mm before it would tip over
  EXPECT_LT(moved(at_the_end), 2e-4f);
}

TEST(BoxOnRound, ADynamicBallBearsABox) {
  Scene scene = on_body(Sphere{1}, {});
  Collider ground;
  ground.position = {0, -1, 0};
  ground.static_friction = ground.kinetic_friction = 0.8f;
  scene.add(ground);
  World world(scene);
  run(world, 120);
  EXPECT_NEAR(length(world.object(0).positions()[0] - world.object(1).positions()[0]), 1.02f, 5e-4f);
}

/// Contacts have the normal of the frame's start, so that the box leans back by what the surface turns in a frame, and
/// loses speed.
TEST(BoxOnRound, WithoutFrictionItSlidesAlongTheSurface) {
  Lying lying;
  lying.friction = 0;
  lying.angle = 0.1f;
  World world(on_collider(lying, ball(1)));
  const double g = 9.81, radius = 1.02;
  for (int frame = 1; frame <= 45; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    const Vec3f p = world.object(0).positions()[0];
    EXPECT_NEAR(length(p), radius, 1.5e-3) << frame;
    const Record& velocity = world.state().velocities[0];
    const Vec3f v{velocity.x, velocity.y, velocity.z};
    const double fallen = radius * std::cos(0.1) - static_cast<double>(p.y);
    EXPECT_NEAR(0.5 * static_cast<double>(dot(v, v)), g * fallen, 0.1 * g * fallen + 1e-3) << frame;
  }
}

TEST(BoxOnRound, ATumblingBoxComesToRest) {
  Lying lying;
  lying.angle = 0.1f;
  lying.height = 0.13f;
  lying.velocity = {0.1f, 0, 0.05f};
  lying.spin = {4, 2, 3};
  World world(on_collider(lying, ball(1)));
  run(world, 120);
  EXPECT_NEAR(length(world.object(0).positions()[0]), 1.02f, 5e-4f);
}

TEST(BoxOnRound, ABallThatTurnsSlowlyCarriesABox) {
  Collider turning = ball(1);
  const float half = 0.2f;  // 0.4 rad in two seconds
  turning.motion.keyframes = {{0, {}, {}}, {2, {}, {0, 0, std::sin(half), std::cos(half)}}};
  Lying lying;
  lying.angle = 0.2f;
  World world(on_collider(lying, turning));
  run(world, 120);
  const Vec3f p = world.object(0).positions()[0];
  EXPECT_NEAR(length(p), 1.02f, 5e-4f);
  EXPECT_NEAR(std::atan2(p.x, p.y), -0.2f, 0.01f);
}

TEST(BoxOnRound, ABallRollsOverABoxAsBefore) {
  // Half of the box covers 0.4 rad of the ball: it touches in one point, which moves with the ball.
  Scene scene;
  BodyOptions options;
  options.mass = 1;
  Object box = make_body({{Box{{0.04f, 0.04f, 0.04f}}}}, options);
  options.position = {0, 0.14f, 0};
  options.velocity = {0.02f, 0, 0};
  options.angular_velocity = {0, 0, -0.2f};
  Object rolling = make_body({{Sphere{0.1f}}}, options);
  box.static_friction = box.kinetic_friction = rolling.static_friction = rolling.kinetic_friction = 0.5f;
  scene.add(box);
  scene.add(rolling);
  Collider ground;
  ground.position = {0, -0.04f, 0};
  ground.static_friction = ground.kinetic_friction = 0.5f;
  scene.add(ground);
  World world(scene);
  run(world, 60);
  EXPECT_NEAR(world.object(1).positions()[0].x, 0.02f, 1e-3f);
}

}  // namespace
}  // namespace pliant
