// Fills of scene files leave out what is solid in the scene, whichever comes first in the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/world.h"

namespace pliant::fills_of_scenes {
namespace {

const std::string colliders = R"("colliders": [
  {"name": "floor", "box": {"half_extents": [0.55, 0.05, 0.55]}, "position": [0, -0.05, 0]},
  {"name": "w0", "box": {"half_extents": [0.05, 0.5, 0.6]}, "position": [-0.55, 0.5, 0]},
  {"name": "w1", "box": {"half_extents": [0.05, 0.5, 0.6]}, "position": [0.55, 0.5, 0]},
  {"name": "w2", "box": {"half_extents": [0.6, 0.5, 0.05]}, "position": [0, 0.5, -0.55]},
  {"name": "w3", "box": {"half_extents": [0.6, 0.5, 0.05]}, "position": [0, 0.5, 0.55]}])";
const std::string ball = R"({"name": "ball", "bodies": [
  {"name": "ball", "solids": [{"sphere": {"radius": 0.18}, "density": 300}], "position": [0, 0.3, 0]}]})";

/// Water of 0.5 m in a tank of 1 x 1 m, with a ball that floats.
std::string ball_in_water(const std::string& more_of_fill = "", const std::string& more = "") {
  return R"({"frames": 240, "objects": [{"name": "w", "liquid": {"fill": {"min": [-0.5, 0, -0.5], "max": [0.5, 0.5, 0.5])" +
         more_of_fill + R"(}, "spacing": 0.05)" + more + "}}, " + ball + "], " + colliders + "}";
}

Scene parse(const std::string& text) { return parse_scene(text, "x.json", "."); }

/// How many points of the lattice are within the ball and half a spacing, less what may touch.
int points_in_ball() {
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = -0.475 + 0.05 * (i % 20), z = -0.475 + 0.05 * (i / 20 % 20), y = 0.025 + 0.05 * (i / 400) - 0.3;
    count += std::sqrt(x * x + y * y + z * z) < 0.18 + 0.99 * 0.025 ? 1 : 0;
  }
  return count;
}

TEST(SceneFill, LeavesOutABodyThatComesLaterInTheFile) {
  const Scene scene = parse(ball_in_water());
  ASSERT_GT(points_in_ball(), 200);
  EXPECT_EQ(static_cast<int>(scene.objects.at(0).positions.size()), 4000 - points_in_ball());
  EXPECT_EQ(scene.objects.at(0).masses.size(), scene.objects.at(0).positions.size());
  EXPECT_EQ(scene.objects.at(0).name, "w");
  EXPECT_EQ(scene.objects.at(1).name, "ball");
}

TEST(SceneFill, KeepsAllIfToldSo) {
  EXPECT_EQ(parse(ball_in_water(R"(, "leave_out_solids": false)")).objects.at(0).positions.size(), 4000U);
}

TEST(SceneFill, KeepsTheCapacity) {
  const Scene scene = parse(ball_in_water("", R"(, "capacity": 4100, "emitters": [{"radius": 0.1, "speed": 1}])"));
  EXPECT_EQ(scene.objects.at(0).positions.size(), 4100U);
  EXPECT_EQ(scene.objects.at(0).masses.size(), 4100U);
  EXPECT_EQ(scene.objects.at(0).flow.spare, 100 + points_in_ball());
}

TEST(SceneFill, SaysWhatItLeftOut) {
  const std::string path = testing::TempDir() + "ball_in_water.json";
  std::ofstream(path) << ball_in_water();
  const SceneFile file = read_scene_file(path);
  ASSERT_EQ(file.left_out.size(), 1U);
  EXPECT_EQ(file.left_out[0], "object 'w': " + std::to_string(points_in_ball()) +
                                  " of the 4000 particles of its fill, which would overlap 'ball'");
}

TEST(SceneFill, IsRefusedInsideASolid) {
  const std::string inside = R"({"objects": [{"name": "w", "liquid": {"fill": {"min": [0, 0, 0], "max": [1, 1, 1]},
    "spacing": 0.25}}], "colliders": [{"name": "rock", "sphere": {"radius": 9}}]})";
  try {
    (void)parse(inside);
    FAIL() << "is accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("all of its 64 particles would overlap 'rock'"), std::string::npos)
        << error.what();
  }
}

/// The water that is left has the volume V and the ball sinks in by its mass: the level is (V + 0.3 of the ball) / 1
/// m^2.
TEST(SceneFill, FloatsABallWithoutAFountain) {
  World world(parse(ball_in_water()));
  float highest = 0;
  for (int frame = 0; frame < 240; ++frame) {
    (void)world.step(1.f / 60);
    for (const Vec3f& p : world.object(0).positions()) highest = std::max(highest, p.y);
  }
  EXPECT_LT(highest, 0.6f);  // 0.85 m where nothing is left out
  const double volume = (4000 - points_in_ball()) * std::pow(0.05, 3), of_ball = 4.18879 * std::pow(0.18, 3);
  std::vector<float> heights;
  for (const Vec3f& p : world.object(0).positions())
    if (p.x * p.x + p.z * p.z > 0.3f * 0.3f) heights.push_back(p.y);
  std::sort(heights.begin(), heights.end());
  const double level = heights[heights.size() - 10] + 0.025;
  EXPECT_NEAR(level, volume + 0.3 * of_ball, 0.03);
}

}  // namespace
}  // namespace pliant::fills_of_scenes
