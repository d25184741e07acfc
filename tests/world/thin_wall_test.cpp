// Tests that fast sticks, bars and balls do not pass a wall that is thinner than their way in a substep.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// Numbers in [-1, 1) that are the same everywhere.
struct Numbers {
  std::uint32_t state;
  float next() {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) * (2.f / 16777216.f) - 1;
  }
};

struct Shot {
  SolidShape shape{};
  float speed = 0;  ///< [m/s]
  float spin = 0;   ///< about each axis at most [rad/s]
};

/// True if a body of 1 kg that is shot along x is behind a wall of 6 by 6 m and 1 cm at x = 0 after half a second.
bool passes(const Shot& shot, std::uint32_t seed) {
  Numbers numbers{seed};
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  Collider wall;
  wall.shape = Box{{0.005f, 3, 3}};
  scene.add(wall);
  BodyOptions options;
  options.position = {-3 + numbers.next(), 0.3f * numbers.next(), 0.3f * numbers.next()};
  const Quatf q{numbers.next(), numbers.next(), numbers.next(), numbers.next()};
  const float size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  options.rotation = {q.x / size, q.y / size, q.z / size, q.w / size};
  options.velocity = {shot.speed, 0, 0};
  options.angular_velocity = Vec3f{numbers.next(), numbers.next(), numbers.next()} * shot.spin;
  options.mass = 1;
  Object body = make_body({{shot.shape}}, options);
  body.static_friction = body.kinetic_friction = 0.3f;
  scene.add(body);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  return world.object(0).positions()[0].x > 0;
}

int count_of_passes(const Shot& shot) {
  int count = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) count += passes(shot, seed) ? 1 : 0;
  return count;
}

TEST(ThinWall, StopsBallsAndBoxes) {
  EXPECT_EQ(count_of_passes({Sphere{0.05f}, 100, 0}), 0);
  EXPECT_EQ(count_of_passes({Box{{0.05f, 0.05f, 0.05f}}, 100, 5}), 0);
}

/// An impact turns a stick by up to a radian in a substep, and its ends come out behind the middle of the wall.
TEST(ThinWall, StopsSticks) {
  EXPECT_LE(count_of_passes({Capsule{0.01f, 0.5f}, 50, 0}), 1);
  EXPECT_LE(count_of_passes({Capsule{0.01f, 0.5f}, 50, 20}), 1);
}

TEST(ThinWall, StopsPlates) { EXPECT_EQ(count_of_passes({Box{{0.5f, 0.005f, 0.5f}}, 20, 5}), 0); }

TEST(ThinWall, StopsMostBars) { EXPECT_LE(count_of_passes({Box{{0.5f, 0.01f, 0.01f}}, 50, 10}), 3); }

}  // namespace
}  // namespace pliant
