// Tests that stacks of boxes that are placed exactly stand still, and do not lean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr int stack_frames = 1200;

/// Rows of cubes, each with `less` fewer than the one below.
Scene stack(int base, int rows, int less, float side) {
  Object boxes;
  boxes.name = "boxes";
  const float half = side / 2;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < base - less * row; ++i) {
      BodyOptions options;
      options.position = {side * (static_cast<float>(i) - 0.5f * static_cast<float>(base - less * row - 1)),
                          half + side * static_cast<float>(row), 0};
      add_body(boxes, {{Box{{half, half, half}}}}, options);
    }
  boxes.static_friction = boxes.kinetic_friction = 0.6f;
  Scene scene;
  scene.colliders.emplace_back();
  scene.add(boxes);
  return scene;
}

struct Stillness {
  double speed = 0;  ///< of the fastest body in the last second [m/s]
  double lean = 0;   ///< farthest way along the ground [m]
  double sag = 0;    ///< farthest way down [m]
};

Stillness stillness_of(const Scene& scene) {
  World world(scene);
  Stillness found;
  for (int frame = 0; frame < stack_frames; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    if (frame < stack_frames - 60) continue;
    for (const Vec3f& v : world.object(0).velocities())
      found.speed = std::max(found.speed, std::sqrt(static_cast<double>(length_squared(v))));
  }
  const std::vector<Vec3f> now = world.object(0).positions(), &start = scene.objects[0].positions;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec3f way = now[i] - start[i];
    found.lean = std::max(found.lean, std::hypot(static_cast<double>(way.x), static_cast<double>(way.z)));
    found.sag = std::max(found.sag, -static_cast<double>(way.y));
  }
  return found;
}

void expect_still_tower(int boxes, float side) {
  const Stillness found = stillness_of(stack(1, boxes, 0, side));
  EXPECT_LT(found.speed, 1e-4) << boxes << " boxes of " << side << " m";
  EXPECT_LT(found.lean, 1e-4) << boxes << " boxes of " << side << " m";
  // The sum of 1.04 h^2 F / m over all contacts (docs/guide/bodies.md), with m half of a box's mass between two.
  const double h = 1. / 480, expected = 1.04 * h * h * 9.81 * boxes * boxes;
  EXPECT_NEAR(found.sag, expected, 0.02 * expected) << boxes << " boxes of " << side << " m";
}

/// The order of points in a contact gives no direction in which a tower could fall.
TEST(StillStack, TowersOfCubesStandUpright) {
  for (const float side : {1.f, 0.1f})
    for (const int boxes : {30, 50}) expect_still_tower(boxes, side);
}

TEST(StillStack, APyramidOf30RowsIsStill) {
  const Stillness found = stillness_of(stack(30, 30, 1, 1));
  EXPECT_LT(found.speed, 2e-4);
  EXPECT_LT(found.sag, 0.015);
}

TEST(StillStack, ACapsuleThatFallsFlatStaysLevel) {
  Scene scene;
  scene.colliders.emplace_back();
  BodyOptions options;
  options.position = {0, 0.6f, 0};
  options.rotation = {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
  scene.add(make_body({{Capsule{0.1f, 0.5f}}}, options));
  World world(scene);
  double tilt = 0;
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    const Vec3f spin = world.object(0).angular_velocities()[0];
    tilt = std::max(tilt, std::sqrt(static_cast<double>(length_squared(spin))));
  }
  EXPECT_LT(tilt, 1e-3);
}

}  // namespace
}  // namespace pliant
