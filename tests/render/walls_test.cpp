// Walls of a tank end where other planes cut them, and drops far away do not move the camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  for (int i = 0; i < 1000; ++i)
    water.positions.push_back(
        {0.1f * static_cast<float>(i % 10), 0.1f * static_cast<float>(i / 10 % 10), 0.1f * static_cast<float>(i / 100)});
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

}  // namespace
}  // namespace pliant::render
