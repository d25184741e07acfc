// Tests how rods in scene files become objects, and what is refused.
#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/rod.h"
#include "scene_support.h"
#include "support/refusal.h"

namespace pliant {
namespace {

using test::named;

TEST(SceneRods, AreReadWithEveryField) {
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& wires = named(scene, "wires");
  ASSERT_EQ(wires.bodies.size(), 8u + 1 + 24 + 2 + 2 * 5 + 2 * 6);  // with the world's body
  EXPECT_EQ(wires.bodies[0].name, "wires 0");
  EXPECT_EQ(wires.bodies[9].name, "spring 0");
  EXPECT_EQ(wires.bodies[33].name, "rod 0");
  EXPECT_NEAR(wires.positions[0].x, 20, 1e-5);
  EXPECT_NEAR(wires.positions[0].z, -0.25, 1e-5);
  EXPECT_NEAR(wires.masses[0], 500 * 3.14159265 * 0.0625 * 0.0625 * 0.5, 1e-4);
  EXPECT_EQ(wires.static_friction, 0.75f);
  EXPECT_EQ(wires.joints[0].break_force, 100);
  EXPECT_EQ(wires.joints[0].break_torque, 50);
  EXPECT_EQ(wires.joints[7].name, "wires start");
  EXPECT_EQ(wires.joints[8].kind, "ball");
  EXPECT_EQ(wires.bodies[35].name, "rod_2_0 0");
  EXPECT_EQ(wires.bodies[45].name, "rod_3_0 0");
  for (int i = 0; i < 5; ++i) {  // the middle of the lower segment is a quarter of a metre off the sphere
    const Vec3f out = wires.positions[static_cast<std::size_t>(35 + 2 * i)] - Vec3f{30, 0, 0};
    EXPECT_NEAR(std::sqrt(length_squared(out)), 2.25, 1e-4);
    EXPECT_GT(out.y, 2.25f * 0.5f);
  }
  EXPECT_NEAR(wires.positions.back().x, 40.5, 1e-5);
  EXPECT_NEAR(wires.positions.back().z, 0.5, 1e-5);
  const ConstraintGroup& group = *std::find_if(wires.constraints.begin(), wires.constraints.end(),
                                               [](const ConstraintGroup& g) { return g.type == "rod_joint"; });
  EXPECT_EQ(group.stiffness.damping, 0.25f);
  const float expected[6] = {1000, 500, 500, 8, 2, 4};  // over the half metre of a segment
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(group.rest[14 + i] * group.rest[14 + i] * 0.5f, expected[i], 1e-3) << i;
}

std::string rod_message(const std::string& rod) {
  return testing_support::refusal([&] { parse_scene(R"({"objects": [{"rod": {)" + rod + "}}]}", "x.json", "."); });
}

TEST(SceneRods, AreRefusedWithAReason) {
  EXPECT_NE(rod_message(R"("radius": 0.01)").find("'points'"), std::string::npos);
  EXPECT_NE(
      rod_message(R"("line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 400}, "radius": 0.01)").find("2.25 radii"),
      std::string::npos);
  EXPECT_NE(rod_message(R"("line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 9}, "start": {"clamped": "wall"})")
                .find("'wall'"),
            std::string::npos);
  EXPECT_NE(
      rod_message(R"("line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 9}, "material": "string")").find("bamboo"),
      std::string::npos);
}

TEST(SceneRods, AreNotTiedOrPinned) {
  const std::string text = R"({"objects": [{"bodies": [{"solids": [{"box": {}}]}], "parts": [
      {"rod": {"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 5}}, "pins": [{"particles": "all"}]}]}]})";
  EXPECT_NE(testing_support::refusal([&] { parse_scene(text, "x.json", "."); }).find("`start` and `end`"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
