// Walls of a tank end where other planes cut them, and drops far away do not move the camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/eye_and_sun.h"
#include "render/geometry.h"
#include "render/matrix.h"
#include "render/walls.h"

namespace pliant::render {
namespace {

const float half = std::sqrt(0.5f);

RenderCollider plane(const Vec3f& at, const Quatf& rotation) { return {Plane{}, at, rotation, {0.5f, 0.5f, 0.5f}}; }

/// A tank from the origin to (2, any height, 1).
std::vector<RenderCollider> tank() {
  return {plane({}, {}), plane({}, {0, 0, -half, half}), plane({2, 0, 0}, {0, 0, half, half}),
          plane({}, {half, 0, 0, half}), plane({0, 0, 1}, {-half, 0, 0, half})};
}

Bounds bounds_of(const Geometry& geometry) {
  Bounds all;
  for (const Vertex& vertex : geometry.vertices) all.include(vertex.position);
  return all;
}

TEST(Walls, AreThePlanesThatAreSteep) {
  EXPECT_FALSE(is_wall(plane({}, {})));
  EXPECT_FALSE(is_wall(plane({}, {0, 0, std::sin(0.25f), std::cos(0.25f)}))) << "a ramp of 29 degrees";
  EXPECT_TRUE(is_wall(plane({}, {half, 0, 0, half})));
}

TEST(Walls, EndWhereOtherPlanesCutThem) {
  const std::vector<RenderCollider> planes = tank();
  const Bounds back = bounds_of(build_wall(planes[3], planes, {1, 0.5f, 0.5f}, 2));
  constexpr float thickness = 0.04f, tolerance = 1e-5f;
  EXPECT_NEAR(back.low.x, -thickness, tolerance);
  EXPECT_NEAR(back.high.x, 2 + thickness, tolerance);
  EXPECT_NEAR(back.low.y, -thickness, tolerance);
  EXPECT_NEAR(back.high.y, 0.5f + 0.55f * 2, tolerance);
  EXPECT_NEAR(back.low.z, -thickness, tolerance);
  EXPECT_NEAR(back.high.z, 0, tolerance);
}

TEST(Walls, ReachUpToACeiling) {
  std::vector<RenderCollider> planes = tank();
  planes.push_back(plane({0, 2.5f, 0}, {1, 0, 0, 0}));
  EXPECT_NEAR(bounds_of(build_wall(planes[3], planes, {1, 0.5f, 0.5f}, 2)).high.y, 2.5f + 0.04f, 1e-5f);
  planes.back().position.y = 20;  // too high for the picture
  EXPECT_NEAR(bounds_of(build_wall(planes[3], planes, {1, 0.5f, 0.5f}, 2)).high.y, 0.5f + 0.55f * 2, 1e-5f);
}

TEST(Walls, FaceWhatTheyHold) {
  const std::vector<RenderCollider> planes = tank();
  for (std::size_t wall = 1; wall < planes.size(); ++wall) {
    const Geometry geometry = build_wall(planes[wall], planes, {1, 0.5f, 0.5f}, 2);
    ASSERT_GE(geometry.indices.size(), 3u);
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
      const Vertex &a = geometry.vertices[geometry.indices[i]], &b = geometry.vertices[geometry.indices[i + 1]],
                   &c = geometry.vertices[geometry.indices[i + 2]];
      EXPECT_GT(dot(cross(b.position - a.position, c.position - a.position), a.normal), 0) << wall << " " << i;
    }
  }
}

TEST(PointsOfInterest, LeaveOutDropsFarFromALiquid) {
  RenderScene scene;
  RenderMesh water;
  water.is_liquid = true;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 10; ++z)
        water.positions.push_back(
            {0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z)});
  const Bounds still = bounds(water.positions);
  for (int i = 0; i < 5; ++i) water.positions.push_back({0.5f, 20 + static_cast<float>(i), -30});
  scene.meshes.push_back(water);
  const Bounds found = bounds(points_of_interest(scene));
  for (float Vec3f::*const axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
    EXPECT_EQ(found.low.*axis, still.low.*axis);
    EXPECT_EQ(found.high.*axis, still.high.*axis);
  }
  scene.meshes[0].is_liquid = false;
  EXPECT_GT(bounds(points_of_interest(scene)).high.y, 20);
}

/// A box of 1 m about the origin.
Geometry box_of_a_metre() {
  Geometry box;
  for (const float x : {-0.5f, 0.5f})
    for (const float y : {-0.5f, 0.5f})
      for (const float z : {-0.5f, 0.5f}) box.vertices.push_back({{x, y, z}, {0, 1, 0}});
  return box;
}

TEST(Sun, KeepsSharpShadowsWhateverFliesAway) {
  const ViewFrame view = view_frame({0, 0, -1});
  const Extent extent{{}, 0.87f};
  Geometry far_drop = box_of_a_metre();
  for (Vertex& vertex : far_drop.vertices) vertex.position = vertex.position + Vec3f{3, -400, 2};
  const Sun alone = make_sun(view, {box_of_a_metre()}, extent);
  const Sun with_drop = make_sun(view, {box_of_a_metre(), far_drop}, extent);
  EXPECT_LT(with_drop.depth, 4 * alone.depth);
  const Sun of_drop = make_sun(view, {far_drop}, extent);
  EXPECT_NEAR(of_drop.depth, alone.depth, 0.01f * alone.depth) << "what is seen alone has its shadow";
}

}  // namespace
}  // namespace pliant::render
