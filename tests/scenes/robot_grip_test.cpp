// The robot arm of scenes/bodies/robot_grip.json lifts a soft ball by the friction of its fingers, turns and holds it.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "pliant/pliant.h"
#include "support/paths.h"

namespace pliant {
namespace {

constexpr int lifted = 210;   ///< frame at which the arm holds the ball above its stand
constexpr int at_rest = 345;  ///< frame at which the arm has turned

Vec3f middle_of_ball(const World& world) {
  const std::vector<Vec3f> points = world.object(1).positions();
  return std::accumulate(points.begin(), points.end(), Vec3f{}) * (1 / static_cast<float>(points.size()));
}

Vec3f middle_of_fingers(const World& world, const Object& arm) {
  const std::vector<Vec3f> points = world.object(0).positions();
  const auto centre = [&](std::size_t body) { return points[static_cast<std::size_t>(arm.bodies[body].particle)]; };
  return (centre(arm.bodies.size() - 1) + centre(arm.bodies.size() - 2)) * 0.5f;
}

float weight(const std::vector<float>& masses, int first) {
  return 9.81f * std::accumulate(masses.begin() + first, masses.end(), 0.f);
}

TEST(RobotGrip, LiftsTheBallAndHoldsItWithoutSlip) {
  const Scene scene = read_scene(test::in_tree("scenes/bodies/robot_grip.json"));
  const Object &arm = scene.objects[0], &ball = scene.objects[1];
  World world(scene);
  world.record_joint_loads(true);
  const float before = middle_of_ball(world).y;
  Vec3f gap{};
  double load = 0;
  for (int frame = 0; frame < scene.frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    if (frame < lifted) continue;
    const Vec3f now = middle_of_ball(world) - middle_of_fingers(world, arm);
    if (frame == lifted) gap = now;
    EXPECT_NEAR(now.y, gap.y, 0.002) << "frame " << frame;
    EXPECT_NEAR(std::hypot(now.x, now.z), std::hypot(gap.x, gap.z), 0.002) << "frame " << frame;
    if (frame < at_rest) continue;
    for (const int finger : {4, 5}) load += world.object(0).mean_joint_load(finger).force.y;
  }
  EXPECT_GT(middle_of_ball(world).y, before + 0.2f);
  // At rest the joints of the fingers bear these and the ball, and nothing else.
  const double expected = weight(ball.masses, 0) + weight(arm.masses, static_cast<int>(arm.masses.size()) - 2);
  EXPECT_NEAR(load / (scene.frames - at_rest), expected, 0.01 * expected);
}

}  // namespace
}  // namespace pliant
