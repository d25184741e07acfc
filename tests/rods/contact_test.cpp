// Rods that touch: stalks and a ball, hair and a head.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "rods/rod_support.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A heavy ball that rolls into rows of stalks.
Scene ball_in_stalks() {
  Scene scene;
  Object grass;
  grass.name = "stalks";
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3f foot{0.2f * static_cast<float>(i), 0, -0.15f + 0.15f * static_cast<float>(j)};
      RodOptions options = clamped_rod(rod_material("nylon line"), 0.006f);
      options.name = "stalk " + std::to_string(3 * i + j);
      add_rod(grass, line(foot, foot + Vec3f{0, 0.7f, 0}, 14), options);
    }
  scene.add(grass);
  BodyOptions ball;
  ball.position = {-0.5f, 0.162f, 0.02f};
  ball.velocity = {4, 0, 0};
  ball.mass = 6;
  scene.add(make_body({{Sphere{0.16f}}}, ball));
  scene.add(Collider{"ground", Plane{}});
  scene.settings.substeps = 8;
  return scene;
}

TEST(RodInContact, IsNotTornByAHeavyBall) {
  const Scene scene = ball_in_stalks();
  World world(scene);
  double fastest = 0, lowest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const Report report = world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    for (const Vec3f& v : world.object(0).velocities()) fastest = std::max(fastest, double(dot(v, v)));
    for (const Vec3f& x : world.object(0).positions()) lowest = std::min(lowest, double(x.y));
  }
  EXPECT_LT(std::sqrt(fastest), 16);  // tips of stalks that the ball lets go; 119 where contact tore the joints open
  EXPECT_GT(lowest, -0.01);
}

TEST(RodInContact, HasTheSameBitsOnAnyThreadsAndLevels) {
  expect_same_bits_on_any_threads_and_levels(ball_in_stalks(), {30, frame_time});
  expect_same_bits_after_a_restore(ball_in_stalks(), {15, frame_time});
}

/// Hair on a head that turns to and fro. What clamps it moves with the head.
Scene head_with_hair() {
  constexpr float radius = 0.1f;
  constexpr int hairs = 80;
  Motion turning;
  turning.pivot = {0, 0.3f, 0};
  turning.repeat = true;
  for (const auto& [time, half] : {std::pair{0.f, 0.f}, {0.4f, 0.5f}, {1.2f, -0.5f}, {1.6f, 0.f}})
    turning.keyframes.push_back({time, {}, {0, std::sin(half), 0, std::cos(half)}});
  Object hair, head;
  hair.name = "hair";
  head.name = "head";
  RodOptions options;
  options.material = material_of(4e6, 1.5e6, 1300);
  options.material.damping = 0.003f;
  options.radius = 0.0006f;
  options.start = {RodEnd::Kind::clamped,
                   add_body(hair, {{Sphere{0.01f}}}, {.name = "scalp", .position = turning.pivot})};
  for (int i = 0; i < hairs; ++i) {
    const double y = 1 - 0.8 * (i + 0.5) / hairs, angle = 2.4 * i, across = std::sqrt(1 - y * y);
    const Vec3f out = convert<float>(Vec3d{across * std::cos(angle), y, across * std::sin(angle)});
    options.name = "hair " + std::to_string(i);
    add_rod(hair, line(turning.pivot + radius * out, turning.pivot + (radius + 0.16f) * out, 16), options);
  }
  hair.self_collision = false;
  hair.damping = 1;
  add_body(head, {{Sphere{0.098f}}}, {.name = "skull", .position = turning.pivot});
  hair.pins = head.pins = {{0, turning}};
  Scene scene;
  scene.add(hair);
  scene.add(head);
  return scene;
}

TEST(RodInContact, OfHairDoesNotPassThroughAHeadThatTurns) {
  const Scene scene = head_with_hair();
  World world(scene);
  const auto nearest = [&] {
    double found = 1;
    const std::vector<Vec3f> x = world.object(0).positions();
    for (std::size_t i = 1; i < x.size(); ++i)
      found = std::min(found, double(length_squared(x[i] - Vec3f{0, 0.3f, 0})));
    return std::sqrt(found);
  };
  for (int frame = 0; frame < 150; ++frame) {
    const Report report = world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    EXPECT_GT(nearest(), 0.085);  // it falls on the head at 1.5 m/s, which is 3 mm in a substep
  }
  EXPECT_GT(nearest(), 0.0978);  // the axis of each segment lies outside
  double lowest = 1;
  for (const Vec3f& x : world.object(0).positions()) lowest = std::min(lowest, double(x.y));
  EXPECT_LT(lowest, 0.25);  // the hair has fallen over the head
}

}  // namespace
}  // namespace pliant
