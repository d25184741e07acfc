// Compares terrain found by index arithmetic with the same terrain as a mesh, triangle by triangle.
#include "collision/fields/heightfield.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pliant/error.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using testing_support::random_vector;

Heightfield random_ground(std::mt19937_64& random, int columns, int rows, const Vec3f& origin) {
  std::vector<float> heights;
  for (int i = 0; i < columns * rows; ++i) heights.push_back(random_vector(random, 0.3f).y);
  return {columns, rows, 0.25f, 0.5f, origin, heights};
}

TEST(Heightfield, FindsTheTrianglesThatAllOfThemWouldGive) {
  std::mt19937_64 random(91);
  for (int i = 0; i < 400; ++i) {
    const Vec3f origin = i % 3 == 0 ? Vec3f{-1000, 50, 2000} : Vec3f{-0.5f, 0, -1};
    const Heightfield ground = random_ground(random, 2 + i % 6, 2 + i % 5, origin);
    const TriangleMesh mesh = ground.mesh();
    ASSERT_EQ(static_cast<int>(mesh.triangles.size()), ground.triangle_count());
    Vec3f middle = origin + Vec3f{0.5f, 0, 1} + random_vector(random, 1.5f);
    if (i % 2 == 0) middle = origin + Vec3f{0.25f * static_cast<float>(i % 5), 0, 0.5f * static_cast<float>(i % 4)};
    const BoxBounds box = BoxBounds{middle, middle}.grown(i % 4 == 0 ? 0.f : 0.3f);
    std::vector<int> found, expected;
    ground.query(box, [&](int t) { found.push_back(t); });
    double least = 0.4;
    for (int t = 0; t < ground.triangle_count(); ++t) {
      Vec3f corners[3];
      ground.corners(t, corners);
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(corners[k], mesh.positions[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k])]);
      ASSERT_GT(triangle_normal(corners[0], corners[1], corners[2]).y, 0);
      if (overlap(BoxBounds::of(corners, 3), box)) expected.push_back(t);
      const auto closest = closest_on_triangle(convert<double>(middle), convert<double>(corners[0]),
                                               convert<double>(corners[1]), convert<double>(corners[2]));
      least = std::min(least, std::sqrt(closest.distance_squared));
    }
    ASSERT_EQ(found, expected) << i;
    const GroundPoint point = ground.closest(middle, 0.4f);
    ASSERT_EQ(point.found, least < 0.4) << i;
    if (point.found) {
      ASSERT_NEAR(point.distance, least, 1e-6);
    }
  }
}

TEST(Heightfield, KnowsAboveFromBelow) {
  const Heightfield ground(3, 3, 1, 1, {0, 2, 0}, std::vector<float>(9, 0.5f));
  const GroundPoint above = ground.closest({1.2f, 3, 0.9f}, 1), below = ground.closest({1.2f, 2, 0.9f}, 1);
  ASSERT_TRUE(above.found && below.found);
  EXPECT_TRUE(above.above);
  EXPECT_FALSE(below.above);
  EXPECT_EQ(above.distance, 0.5f);
  EXPECT_EQ(below.point.y, 2.5f);
  EXPECT_FALSE(ground.closest({1, 9, 1}, 1).found);
  EXPECT_FALSE(ground.closest({-1e30f, 2, 1e30f}, 1).found);
}

TEST(Heightfield, RefusesWhatIsNone) {
  EXPECT_THROW(Heightfield(1, 2, 1, 1, {}, {0, 0}), Error);
  EXPECT_THROW(Heightfield(2, 2, 1, 1, {}, {0, 0}), Error);
  EXPECT_THROW(Heightfield(2, 2, 0, 1, {}, {0, 0, 0, 0}), Error);
  EXPECT_THROW(Heightfield(2, 2, 1, 1, {}, {0, 0, 0, std::nanf("")}), Error);
}

}  // namespace
}  // namespace pliant
