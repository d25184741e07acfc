// Compares hulls with the definition: convex, closed, and every point inside.
#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "geometry/exact.h"
#include "geometry/geometry_support.h"
#include "geometry/mass_properties.h"
#include "math/vector.h"

namespace pliant {
namespace {

using testing_support::random_point;

/// Every edge is used once in each direction, no point is outside by more than roundings, Euler's formula holds.
void expect_hull_of(const std::vector<Vec3f>& points, const ConvexHull& hull) {
  std::set<std::pair<int, int>> edges;
  for (const std::vector<int>& face : hull.faces) {
    ASSERT_GE(face.size(), 3U);
    for (std::size_t i = 0; i < face.size(); ++i)
      EXPECT_TRUE(edges.insert({face[i], face[(i + 1) % face.size()]}).second) << "an edge is used twice";
  }
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a}) == 1) << "an edge has one face";
  EXPECT_EQ(hull.corners.size() + hull.faces.size(), edges.size() / 2 + 2);
  double size = 0;
  for (const Vec3f& p : points) size = std::max(size, double(largest(p - points[0])));
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const Vec3d normal = convert<double>(hull.normals[f]), on = convert<double>(hull.corners[hull.faces[f][0]]);
    EXPECT_NEAR(length(normal), 1, 1e-6);
    for (const Vec3f& p : points) EXPECT_LT(dot(normal, convert<double>(p) - on), 2e-5 * size);
  }
  for (const Vec3f& corner : hull.corners)
    EXPECT_TRUE(std::find(points.begin(), points.end(), corner) != points.end()) << "corners are points";
}

double volume_of(const ConvexHull& hull) {
  std::vector<Vec3d> corners;
  for (const Vec3f& corner : hull.corners) corners.push_back(convert<double>(corner));
  return moments_of_mesh(corners, hull.triangles()).mass;
}

TEST(ConvexHull, OfABoxWithPointsOnAndInItHasSixFacesOfFour) {
  std::vector<Vec3f> points;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) points.push_back({0.5f * float(x), 0.25f * float(y), 0.125f * float(z)});
  const auto hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  expect_hull_of(points, *hull);
  EXPECT_EQ(hull->faces.size(), 6U);
  EXPECT_EQ(hull->corners.size(), 8U);
  EXPECT_NEAR(volume_of(*hull), 2 * 1 * 0.5, 1e-12);
}

TEST(ConvexHull, OfATurnedBoxHasSixFacesToo) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Quatd q = normalise(Quatd{random_point<float>(random).x, random_point<float>(random).y,
                                    random_point<float>(random).z, random_point<float>(random).x});
    const Vec3d half = abs(convert<double>(random_point<float>(random))) + Vec3d{0.1, 0.1, 0.1};
    std::vector<Vec3f> points;
    for (int i = 0; i < 8; ++i)
      points.push_back(convert<float>(rotate(q, Vec3d{(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                                      (i & 4) != 0 ? half.z : -half.z})));
    const auto hull = convex_hull(points);
    ASSERT_TRUE(hull.has_value());
    expect_hull_of(points, *hull);
    EXPECT_EQ(hull->faces.size(), 6U) << trial;
  }
}

TEST(ConvexHull, OfRandomPointsContainsThemAll) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vec3f> points;
    const int count = 4 + trial * 5;
    for (int i = 0; i < count; ++i) points.push_back(random_point<float>(random));
    const auto hull = convex_hull(points);
    ASSERT_TRUE(hull.has_value());
    expect_hull_of(points, *hull);
  }
}

TEST(ConvexHull, OfPointsOnASphereHasThemAllAsCorners) {
  std::mt19937_64 random(11);
  std::vector<Vec3f> points;
  for (int i = 0; i < 2000; ++i) points.push_back(unit_or(random_point<float>(random), Vec3f{0, 1, 0}));
  const auto hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  EXPECT_GT(hull->corners.size(), 1990U);  // a few may lie in the plane of neighbours up to rounding
  EXPECT_NEAR(volume_of(*hull), 4.18879, 0.05);
}

/// Integer coordinates: many points in one plane, on one line, and at one place.
TEST(ConvexHull, OfPointsOnALatticeIsExact) {
  std::mt19937_64 random(17);
  int solid = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<Vec3f> points;
    const int range = 1 + trial % 3;
    std::uniform_int_distribution<int> uniform(-range, range);
    for (int i = 0; i < 4 + trial % 30; ++i) {
      const int x = uniform(random), y = uniform(random), z = uniform(random);
      points.push_back({float(x), float(y), float(z)});
    }
    bool flat = true;
    for (std::size_t i = 1; i < points.size() && flat; ++i)
      for (std::size_t j = i + 1; j < points.size() && flat; ++j)
        for (std::size_t k = j + 1; k < points.size() && flat; ++k)
          flat = volume_sign(points[0], points[i], points[j], points[k]) == 0;
    const auto hull = convex_hull(points);
    ASSERT_EQ(hull.has_value(), !flat);
    if (!hull) continue;
    ++solid;
    expect_hull_of(points, *hull);
    for (const std::vector<int>& face : hull->faces)
      for (const Vec3f& p : points)
        EXPECT_LE(volume_sign(hull->corners[face[0]], hull->corners[face[1]], hull->corners[face[2]], p), 0);
  }
  EXPECT_GT(solid, 300);
}

TEST(ConvexHull, OfFlatOrFewPointsIsNone) {
  EXPECT_FALSE(convex_hull({}).has_value());
  EXPECT_FALSE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).has_value());
  EXPECT_FALSE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {3, 2, 0}}).has_value());
  EXPECT_FALSE(convex_hull({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).has_value());
  EXPECT_TRUE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25f, 0.25f, 1e-30f}}).has_value()) << "thin, but solid";
}

}  // namespace
}  // namespace pliant
