// Tests that a box rides on a turntable that turns by keyframes, where friction holds it.
#include <gtest/gtest.h>

#include <cmath>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float pi = 3.14159265f;

/// The distance from the axis after `seconds`, of a box let go at a metre with the speed of the table [m].
double radius_after(float speed, int seconds) {
  Scene scene;
  Collider table;
  table.shape = Box{{2, 0.1f, 2}};
  table.position = {0, -0.1f, 0};
  table.static_friction = table.kinetic_friction = 1;
  for (int i = 0; i <= 8 * seconds; ++i) {
    const float time = static_cast<float>(i) / 8, half = speed * time / 2;
    table.motion.keyframes.push_back({time, {}, Quatf{0, std::sin(half), 0, std::cos(half)}});
  }
  scene.add(table);
  BodyOptions options;
  options.position = {1, 0.1f, 0};
  options.velocity = {0, 0, -speed};
  options.angular_velocity = {0, speed, 0};
  Object box = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options);
  box.static_friction = box.kinetic_friction = 1;
  scene.add(box);
  World world(scene);
  for (int frame = 0; frame < 60 * seconds; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  const Vec3f x = world.object(0).positions()[0];
  return std::hypot(static_cast<double>(x.x), static_cast<double>(x.z));
}

/// Friction of 1 holds it up to 3.1 rad/s.
TEST(Turntable, CarriesABoxRound) {
  EXPECT_NEAR(radius_after(pi / 4, 5), 1, 1e-3);
  EXPECT_NEAR(radius_after(pi / 2, 5), 1, 4e-3);
}

TEST(Turntable, ThrowsOutWhatFrictionCannotHold) { EXPECT_GT(radius_after(pi, 3), 2); }

}  // namespace
}  // namespace pliant
