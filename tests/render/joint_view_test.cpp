// Tests what is drawn of joints and rods.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/rod.h"
#include "render/render.h"

namespace pliant::render {
namespace {

constexpr float infinite_mass = std::numeric_limits<float>::infinity();

/// A fixed box at a height of 2 m, and others below it at x = -0.5 m, 0.5 m, ...
Object hanging_boxes(int count) {
  Object object;
  add_body(object, {{Box{{0.6f, 0.05f, 0.1f}}}}, {.name = "beam", .position = {0, 2, 0}, .mass = infinite_mass});
  for (int i = 0; i < count; ++i)
    add_body(object, {{Box{{0.1f, 0.1f, 0.1f}}}},
             {.name = "box " + std::to_string(i), .position = {static_cast<float>(i) - 0.5f, 1, 0}});
  return object;
}

RenderScene picture_of(const Object& object, int frames) {
  Scene scene;
  scene.add(object);
  World world(scene);
  for (int frame = 0; frame < frames; ++frame) world.step(1.f / 60);
  return make_render_scene(scene, world);
}

float apart(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(a - b)); }

TEST(JointView, OfASpringIsACoilWithTheSameTurnsAtAnyLength) {
  Object object = hanging_boxes(1);
  add_joint(object,
            SpringJoint{.a = 0, .b = 1, .anchor_a = {-0.5f, 1.9f, 0}, .anchor_b = {-0.5f, 1.1f, 0}, .stiffness = 50});
  const RenderScene before = picture_of(object, 0), after = picture_of(object, 20);
  ASSERT_EQ(before.tubes.size(), 1u);
  ASSERT_EQ(after.tubes.size(), 1u);
  const std::vector<Vec3f>&at_rest = before.tubes[0].points, &stretched = after.tubes[0].points;
  EXPECT_GT(at_rest.size(), 100u) << "a straight line";
  EXPECT_EQ(at_rest.size(), stretched.size());
  EXPECT_NEAR(apart(at_rest.front(), at_rest.back()), 0.8f, 1e-5f);
  EXPECT_GT(apart(stretched.front(), stretched.back()), 0.9f);
  EXPECT_EQ(stretched.front(), (Vec3f{-0.5f, 1.9f, 0}));
  float out = 0;
  for (const Vec3f& p : stretched) out = std::max(out, std::hypot(p.x + 0.5f, p.z));
  EXPECT_GT(out, 0.03f);
  EXPECT_LT(out, 0.1f) << "wider than the box";
}

TEST(JointView, OfAPulleyIsARopeFromBodyToBody) {
  Object object = hanging_boxes(2);
  add_joint(object, PulleyJoint{.a = 1,
                                .b = 2,
                                .anchor_a = {-0.5f, 1.1f, 0},
                                .anchor_b = {0.5f, 1.1f, 0},
                                .pulley_a = {-0.5f, 1.9f, 0},
                                .pulley_b = {0.5f, 1.9f, 0},
                                .carrier = 0});
  const RenderScene picture = picture_of(object, 0);
  ASSERT_EQ(picture.tubes.size(), 1u);
  const std::vector<Vec3f> path{{-0.5f, 1.1f, 0}, {-0.5f, 1.9f, 0}, {0.5f, 1.9f, 0}, {0.5f, 1.1f, 0}};
  ASSERT_EQ(picture.tubes[0].points.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_LT(apart(picture.tubes[0].points[i], path[i]), 1e-5f) << i;
}

TEST(JointView, OfADistanceIsAStraightThread) {
  Object object = hanging_boxes(1);
  add_joint(object, DistanceJoint{.a = 0, .b = 1, .anchor_a = {-0.5f, 1.9f, 0}, .anchor_b = {-0.5f, 1.1f, 0}});
  const RenderScene picture = picture_of(object, 0);
  ASSERT_EQ(picture.tubes.size(), 1u);
  EXPECT_EQ(picture.tubes[0].points.size(), 2u);
  EXPECT_LT(picture.tubes[0].radius, 0.01f);
}

std::vector<Vec3f> line(int points) {
  std::vector<Vec3f> result;
  for (int i = 0; i < points; ++i) result.push_back({0.1f * static_cast<float>(i), 1, 0});
  return result;
}

TEST(RodView, IsOneTubeThroughAllPoints) {
  const std::vector<Vec3f> points = line(6);
  const Object rod = make_rod(points, {.material = rod_material("rubber cord"), .radius = 0.01f, .end_radius = 0.004f});
  const RenderScene picture = picture_of(rod, 0);
  EXPECT_TRUE(picture.bodies.empty()) << "segments are drawn a second time";
  ASSERT_EQ(picture.tubes.size(), 1u);
  const RenderTube& tube = picture.tubes[0];
  ASSERT_EQ(tube.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT(apart(tube.points[i], points[i]), 1e-5f) << i;
  ASSERT_EQ(tube.radii.size(), points.size());
  EXPECT_GT(tube.radii.front(), 0.009f);
  EXPECT_LT(tube.radii.back(), 0.005f);
}

TEST(RodView, IsTwoTubesOnceItIsBroken) {
  Object rod = make_rod(line(6), {.material = rod_material("rubber cord"),
                                  .radius = 0.01f,
                                  .start = {.kind = RodEnd::Kind::clamped},
                                  .break_torque = 1e-4f});
  const RenderScene picture = picture_of(rod, 30);
  EXPECT_GT(picture.tubes.size(), 1u) << "it did not break, or is drawn as if it had not";
  for (const RenderTube& tube : picture.tubes) EXPECT_EQ(tube.colour, picture.tubes[0].colour) << "it is one rod";
}

TEST(RodView, LeavesBodiesThatHoldItAsTheyAre) {
  Object object;
  add_body(object, {{Capsule{0.05f, 0.1f}}}, {.name = "holder", .position = {0, 1, 0}, .mass = infinite_mass});
  add_rod(
      object, line(4),
      {.material = rod_material("rubber cord"), .radius = 0.01f, .start = {.kind = RodEnd::Kind::clamped, .body = 0}});
  const RenderScene picture = picture_of(object, 0);
  EXPECT_EQ(picture.bodies.size(), 1u);
  ASSERT_EQ(picture.tubes.size(), 1u);
  EXPECT_EQ(picture.tubes[0].points.size(), 4u);
}

}  // namespace
}  // namespace pliant::render
