// Tests slender bodies: sticks that slide and spin on the floor, down to a hundredth of a millimetre.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// A stick of a metre along x, half as thick as `radius`, a little above the floor.
Object stick(const SolidShape& shape, float radius, float speed) {
  BodyOptions options;
  options.position = {0, 2 * radius, 0};
  options.velocity = {speed, 0, speed / 2};
  options.angular_velocity = {0, speed, 0};
  const bool is_box = std::holds_alternative<Box>(shape);
  const float half = std::sqrt(0.5f);
  return make_body({{shape, {}, is_box ? Quatf{} : Quatf{0, 0, half, half}}}, options);
}

std::vector<SolidShape> shapes_of(float radius) {
  return {Box{{0.5f, radius, radius}}, Capsule{radius, 0.5f}, Cylinder{radius, 0.5f}};
}

Scene slender_scene(Object object, float friction) {
  object.static_friction = object.kinetic_friction = friction;
  Scene scene;
  scene.colliders.emplace_back();
  scene.colliders.back().static_friction = scene.colliders.back().kinetic_friction = friction;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return scene;
}

/// Without friction it slides and spins on for ever, flat on the floor. Its inertia turns with it, and so must its
/// contacts.
TEST(SlenderBody, SpinsOnWithoutFriction) {
  for (const float radius : {0.02f, 0.01f, 0.005f, 0.002f})
    for (const SolidShape& shape : shapes_of(radius)) {
      World world(slender_scene(stick(shape, radius, 8), 0));
      float highest = 0;
      for (int frame = 0; frame < 240; ++frame) {
        ASSERT_TRUE(world.step(1.f / 60).ok());
        if (frame > 30) highest = std::max(highest, world.object(0).positions()[0].y);
      }
      const std::string which = "radius " + std::to_string(radius) + ", shape " + std::to_string(shape.index());
      const Vec3f at = world.object(0).positions()[0];
      EXPECT_NEAR(at.x, 32, 1e-2) << which;
      EXPECT_NEAR(at.z, 16, 1e-2) << which;
      EXPECT_LT(highest, 1.5f * radius) << which;
      EXPECT_NEAR(world.state().frames.angular_velocities[0].y * world.state().frames.angular_velocities[0].y +
                      world.state().frames.angular_velocities[0].z * world.state().frames.angular_velocities[0].z,
                  64, 2)
          << which;
    }
}

/// With friction it comes to rest where it is; however thin, it is not thrown.
TEST(SlenderBody, IsNotThrownByFriction) {
  for (const float radius : {0.02f, 0.005f, 1e-3f, 2e-4f, 5e-5f, 1e-5f})
    for (const SolidShape& shape : shapes_of(radius))
      for (const float speed : {0.f, 2.f}) {
        World world(slender_scene(stick(shape, radius, speed), 0.4f));
        float highest = 0;
        for (int frame = 0; frame < 240; ++frame) {
          ASSERT_TRUE(world.step(1.f / 60).ok());
          highest = std::max(highest, world.object(0).positions()[0].y);
        }
        const std::string which = "radius " + std::to_string(radius) + ", shape " + std::to_string(shape.index()) +
                                  ", " + std::to_string(speed);
        EXPECT_LT(highest, 0.1f) << which;
        EXPECT_GT(world.object(0).positions()[0].y, 0.5f * radius - 2e-4f) << which;
      }
}

/// A thin stick that is thrown flat rolls fast about its own axis as it slides and spins about the vertical. Contacts
/// turned with it about its axis and saw the other spin as one that lifts an end, so that boxes balanced on the contact
/// of their centre and sank by up to 1.5 mm: 12 of 60 that are thinner than half a millimetre.
TEST(SlenderBody, StaysOnTheFloorAsItRolls) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0.9f, 1.1f);
  for (const float frames_a_second : {30.f, 60.f, 240.f})
    for (const float radius : {2e-3f, 8e-4f, 4e-4f, 2e-4f, 5e-5f, 1e-5f})
      for (const bool is_hull : {false, true})
        for (int run = 0; run < 6; ++run) {
          const float along = 0.5f, r = radius;
          Hull hull;
          for (const float x : {-along, along})
            for (const Vec3f& corner : {Vec3f{x, r, 0}, {x, -r, -r}, {x, -r, r}}) hull.points.push_back(corner);
          const SolidShape shape = is_hull ? SolidShape{hull} : SolidShape{Box{{along, r, r}}};
          BodyOptions options;
          options.position = {0, 2 * r, 0};
          options.velocity = {2 * share(random), 0, 1 * share(random)};
          options.angular_velocity = {0, 2 * share(random), 0};
          World world(slender_scene(make_body({{shape}}, options), 0.4f));
          for (int frame = 0; frame < static_cast<int>(2 * frames_a_second); ++frame)
            ASSERT_TRUE(world.step(1 / frames_a_second).ok());
          const float sag = 0.09e-3f * (60 * 60) / (frames_a_second * frames_a_second);  // of a contact under gravity
          EXPECT_GT(world.object(0).positions()[0].y, (is_hull ? 0.59f : 1) * r - sag - 2e-4f)
              << "radius " << radius << (is_hull ? ", hull, " : ", box, ") << frames_a_second << " frames a second";
        }
}

/// A cylinder that is thinner than the slack of contact lies on its side, and a coin on its face.
TEST(SlenderBody, LiesOnItsLongerSide) {
  const float half = std::sqrt(0.5f);
  for (const bool is_coin : {false, true}) {
    BodyOptions options;
    options.position = {0, 0.01f, 0};
    const SolidShape shape = is_coin ? Cylinder{0.5f, 1e-3f} : Cylinder{1e-3f, 0.5f};
    World world(slender_scene(make_body({{shape, {}, is_coin ? Quatf{} : Quatf{0, 0, half, half}}}, options), 0.4f));
    for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    EXPECT_NEAR(world.object(0).positions()[0].y, 1e-3f, 2e-4f) << is_coin;
  }
}

}  // namespace
}  // namespace pliant
