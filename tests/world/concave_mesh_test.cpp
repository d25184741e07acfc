// Tests bodies in hollows of meshes and heightfields: on its way a body meets triangles that rise ahead of it, and the
// wall of a drum turns under what rides in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

/// The wall of a tube about the z-axis, `columns` flat strips through points at a radius, with the centres of strips at
/// the lowest place and every 2 pi / columns from there.
MeshCollider pipe(int columns, float radius, float half_length) {
  MeshCollider wall;
  for (int i = 0; i < columns; ++i) {
    const double angle = 6.283185307179586 * (i + 0.5) / columns;
    for (const float z : {-half_length, half_length})
      wall.mesh.positions.push_back(
          {radius * static_cast<float>(std::sin(angle)), -radius * static_cast<float>(std::cos(angle)), z});
  }
  for (int i = 0; i < columns; ++i) {
    const int next = (i + 1) % columns;
    wall.mesh.triangles.push_back({2 * i, 2 * next, 2 * i + 1});
    wall.mesh.triangles.push_back({2 * next, 2 * next + 1, 2 * i + 1});
  }
  wall.static_friction = wall.kinetic_friction = 0;
  return wall;
}

/// Along z a valley whose height is that of a cosine, 6 m wide.
MeshCollider valley(float depth, MeshCollider::As as) {
  constexpr int columns = 201, rows = 5;
  MeshCollider ground;
  ground.as = as;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = -3 + 6. * column / (columns - 1);
      ground.mesh.positions.push_back({static_cast<float>(x),
                                       depth / 2 * static_cast<float>(1 - std::cos(1.0471975511965976 * x)),
                                       static_cast<float>(row) - 2});
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      ground.mesh.triangles.push_back({a, c, b});
      ground.mesh.triangles.push_back({b, c, d});
    }
  ground.static_friction = ground.kinetic_friction = 0;
  return ground;
}

Object ball(float radius, const Vec3f& position, const Vec3f& velocity) {
  BodyOptions options;
  options.position = position;
  options.velocity = velocity;
  Object object = make_body({{Sphere{radius}}}, options);
  object.static_friction = object.kinetic_friction = 0;
  return object;
}

class BallInAPipe : public testing::TestWithParam<std::tuple<float, float>> {};
INSTANTIATE_TEST_SUITE_P(SpeedsAndRadii, BallInAPipe,
                         testing::Combine(testing::Values(1.f, 2.f, 4.f, 6.f, 10.f),
                                          testing::Values(0.02f, 0.05f, 0.2f)));

/// Straight on for a frame, the ball would be up to 14 mm deep in the wall at the end of each.
TEST_P(BallInAPipe, FollowsTheWall) {
  const auto [speed, radius] = GetParam();
  const float wall = std::cos(3.14159265f / 192);
  Scene scene;
  scene.gravity = {};
  scene.add(pipe(192, 1, 0.4f));
  scene.add(ball(radius, {0, radius - wall, 0}, {speed, 0, 0}));
  World world(scene);
  float deepest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const Report report = world.step(dt);
    ASSERT_TRUE(report.ok()) << report.explain();
    const Vec3f p = world.object(0).positions()[0];
    deepest = std::max(deepest, std::hypot(p.x, p.y) + radius - 1);
  }
  EXPECT_LT(deepest, 1.5e-3f);
  // Without restitution each strip takes the part of the speed that is across it.
  const float turn = 6.2831853f / 192, strips = 2 * speed / (turn * (1 - radius));
  const float now = length(world.object(0).velocities()[0]);
  EXPECT_GT(now, 0.96f * speed * std::pow(std::cos(turn), strips));
  EXPECT_LT(now, 1.0001f * speed);
}

class BallInAValley : public testing::TestWithParam<std::tuple<MeshCollider::As, float>> {};
INSTANTIATE_TEST_SUITE_P(KindsAndRadii, BallInAValley,
                         testing::Combine(testing::Values(MeshCollider::As::triangles, MeshCollider::As::heightfield),
                                          testing::Values(0.02f, 0.05f, 0.2f)));

/// From near the edge it comes through the lowest place at up to 6 m/s.
TEST_P(BallInAValley, StaysOnTheGround) {
  const auto [kind, radius] = GetParam();
  constexpr float depth = 2;
  Scene scene;
  scene.add(valley(depth, kind));
  scene.add(ball(radius, {-2.5f, 1.8661f + 1.4f * radius, 0}, {}));
  World world(scene);
  float deepest = 0, fastest = 0;
  for (int frame = 0; frame < 240; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    const Vec3f p = world.object(0).positions()[0];
    float nearest = 1e30f;
    for (int i = -400; i <= 400; ++i) {
      const float x = p.x + 1e-3f * static_cast<float>(i);
      nearest = std::min(nearest, std::hypot(x - p.x, depth / 2 * (1 - std::cos(1.04719755f * x)) - p.y));
    }
    const bool is_above = p.y > depth / 2 * (1 - std::cos(1.04719755f * p.x));
    deepest = std::max(deepest, radius + (is_above ? -nearest : nearest));
    fastest = std::max(fastest, length(world.object(0).velocities()[0]));
  }
  EXPECT_LT(deepest, 2e-3f);
  EXPECT_GT(fastest, 5.8f) << "no friction, 1.86 m down";
}

/// Plates on the wall of a mesh that turns by itself. Straight on, they would be 0.7 mm deeper in it after each frame.
TEST(Drum, KeepsThinPlates) {
  MeshCollider drum = pipe(24, 0.5f, 0.4f);
  drum.static_friction = 0.6f, drum.kinetic_friction = 0.5f;
  drum.motion = {
      {Keyframe{0, {}, {}}, Keyframe{0.5f, {}, {}}, Keyframe{6.5f, {}, rotation({0, 0, 1}, 1080)}}, {0, 0, 1}, false};
  Scene scene;
  scene.add(drum);
  for (const float z : {-0.45f, 0.45f}) {
    Collider lid;
    lid.shape = Box{{1, 1, 0.05f}};
    lid.position = {0, 0, z};
    scene.add(lid);
  }
  Object plates;
  plates.collides = plates.self_collision = true;
  plates.static_friction = 0.6f, plates.kinetic_friction = 0.5f;
  constexpr int count = 24;
  for (int i = 0; i < count; ++i) {
    BodyOptions options;
    options.position = {0.2f * static_cast<float>(i % 3 - 1), -0.3f + 0.1f * static_cast<float>(i / 6),
                        0.2f * static_cast<float>(i / 3 % 2) - 0.1f};
    options.rotation = rotation({0, 1, 0}, 50.f * static_cast<float>(i));
    add_body(plates, {{Box{{0.08f, 0.005f, 0.05f}}}}, options);
  }
  scene.add(plates);
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) ASSERT_TRUE(world.step(dt).ok());
  int inside = 0;
  for (const Vec3f& p : world.object(0).positions()) inside += std::hypot(p.x, p.y) < 0.5f ? 1 : 0;
  EXPECT_EQ(inside, count);
}

}  // namespace
}  // namespace pliant
