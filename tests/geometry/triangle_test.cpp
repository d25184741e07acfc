// Tests closest points by known answers, and by the condition that characterises a closest point of a convex set.
//
// r is the point of a convex set nearest to p if and only if (p - r) . (v - r) <= 0 for each of its corners v. The
// condition does not depend on how r was found, so it works for slivers and parallel edges too.
#include "geometry/triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/geometry_support.h"

namespace pliant {
namespace {

using testing_support::expect_near;
using testing_support::random_point;

/// By how much a point fails the condition [m].
double excess(const Vec3d& p, const Vec3d& r, const Vec3d (&corners)[3]) {
  const Vec3d away = p - r;
  const double size = std::max(length(away), 1e-30);
  double worst = 0;
  for (const Vec3d& corner : corners) worst = std::max(worst, dot(away, corner - r) / size);
  return worst;
}

template <class R>
void check_triangle(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c, double tolerance,
                    double place_tolerance) {
  const auto found = closest_on_triangle(p, a, b, c);
  const auto& w = found.weights;
  ASSERT_TRUE(w.x >= 0 && w.y >= 0 && w.z >= 0);
  ASSERT_NEAR(w.x + w.y + w.z, 1, tolerance);
  const Vec3d corners[3] = {convert<double>(a), convert<double>(b), convert<double>(c)};
  const Vec3d r = corners[0] * static_cast<double>(w.x) + corners[1] * static_cast<double>(w.y) +
                  corners[2] * static_cast<double>(w.z);
  expect_near(convert<double>(found.point), r, tolerance * 3);
  ASSERT_NEAR(found.distance_squared, length_squared(convert<double>(p) - r), tolerance * 10);
  // If the distance is small, its direction says little about the position.
  const double distance = length(convert<double>(p) - r);
  ASSERT_LE(excess(convert<double>(p), r, corners) * std::min(1.0, distance), place_tolerance);
}

TEST(ClosestOnTriangle, KnowsItsSevenRegions) {
  const Vec3d a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  const struct {
    Vec3d p, closest, weights;
  } cases[] = {
      {{0.5, 0.5, 3}, {0.5, 0.5, 0}, {0.5, 0.25, 0.25}},  // inside
      {{1, -1, 1}, {1, 0, 0}, {0.5, 0.5, 0}},             // edges
      {{2, 2, -1}, {1, 1, 0}, {0, 0.5, 0.5}},
      {{-1, 1, 0}, {0, 1, 0}, {0.5, 0, 0.5}},
      {{-1, -1, 0}, {0, 0, 0}, {1, 0, 0}},  // corners
      {{4, -1, 0}, {2, 0, 0}, {0, 1, 0}},
      {{-1, 9, 1}, {0, 2, 0}, {0, 0, 1}},
  };
  for (const auto& known : cases) {
    const auto found = closest_on_triangle(known.p, a, b, c);
    expect_near(found.point, known.closest);
    expect_near(found.weights, known.weights);
    EXPECT_NEAR(found.distance_squared, length_squared(known.p - known.closest), 1e-12);
  }
}

TEST(ClosestOnTriangle, IsOptimalForRandomTrianglesAndSlivers) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto p = random_point<double>(random), a = random_point<double>(random), b = random_point<double>(random);
    const double height = std::pow(10.0, -(i % 20));  // from well shaped to flatter than double can resolve
    const auto c = a + (b - a) * (0.3 + 2.0 * (i % 7 - 3)) + random_point<double>(random) * height;
    check_triangle(p, a, b, c, 1e-13, 1e-10);
    const Vec3f single[4] = {convert<float>(p), convert<float>(a), convert<float>(b), convert<float>(c)};
    check_triangle(single[0], single[1], single[2], single[3], 2e-6, 3e-3);
    const auto exact = closest_on_triangle(convert<double>(single[0]), convert<double>(single[1]),
                                           convert<double>(single[2]), convert<double>(single[3]));
    const auto found = closest_on_triangle(single[0], single[1], single[2], single[3]);
    ASSERT_NEAR(found.distance_squared, exact.distance_squared, 5e-6 * (1 + exact.distance_squared));
  }
}

TEST(ClosestOnTriangle, IsNeverFartherThanAnySample) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 300; ++i) {
    const auto p = random_point<float>(random), a = random_point<float>(random), b = random_point<float>(random);
    const auto c = i % 3 == 0 ? a + (b - a) * 0.4f : random_point<float>(random);
    const auto found = closest_on_triangle(p, a, b, c);
    for (int k = 0; k <= 20; ++k) {
      for (int m = 0; m + k <= 20; ++m) {
        const Vec3f sample = a + (b - a) * (static_cast<float>(k) / 20) + (c - a) * (static_cast<float>(m) / 20);
        ASSERT_LE(found.distance_squared, length_squared(p - sample) + 2e-6f);
      }
    }
  }
}

TEST(ClosestOnTriangle, TreatsSegmentsPointsAndTinyAndDistantTriangles) {
  const Vec3d p{0.25, 1, 0}, a{0, 0, 0}, b{1, 0, 0};
  expect_near(closest_on_triangle(p, a, b, b).point, {0.25, 0, 0});
  expect_near(closest_on_triangle(p, a, a, b).point, {0.25, 0, 0});
  expect_near(closest_on_triangle(p, a, b, a).point, {0.25, 0, 0});
  expect_near(closest_on_triangle(p, b, a, Vec3d{0.5, 0, 0}).point, {0.25, 0, 0});
  expect_near(closest_on_triangle(p, b, b, b).point, b);
  expect_near(closest_on_triangle(b, b, b, b).point, b);
  const auto tiny = closest_on_triangle(Vec3f{1, 1, 1}, Vec3f{0, 0, 0}, Vec3f{1e-30f, 0, 0}, Vec3f{0, 1e-30f, 0});
  EXPECT_NEAR(tiny.distance_squared, 3, 1e-6);
  EXPECT_NEAR(tiny.weights.x + tiny.weights.y + tiny.weights.z, 1, 1e-6);
  const Vec3f far{1000, 2000, -500};
  const auto distant =
      closest_on_triangle(far + Vec3f{0.25f, 0.25f, 1}, far, far + Vec3f{1, 0, 0}, far + Vec3f{0, 1, 0});
  expect_near(convert<double>(distant.weights), {0.5, 0.25, 0.25}, 1e-6);
  EXPECT_EQ(distant.distance_squared, 1);
}

TEST(ClosestOnTriangle, KeepsSmallDistancesFarFromTheOrigin) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    const Vec3f far = random_point<float>(random, 1000);
    const Vec3f a = far + random_point<float>(random, 0.01), b = far + random_point<float>(random, 0.01);
    const Vec3f c = far + random_point<float>(random, 0.01), p = far + random_point<float>(random, 0.01);
    const double exact =
        closest_on_triangle(convert<double>(p), convert<double>(a), convert<double>(b), convert<double>(c))
            .distance_squared;
    ASSERT_NEAR(closest_on_triangle(p, a, b, c).distance_squared, exact, 1e-5 * exact + 1e-9);
  }
}

template <class R>
void check_segments(const Vec3<R> (&p)[2], const Vec3<R> (&q)[2], double tolerance, double place_tolerance) {
  const auto found = closest_on_segments(p, q);
  ASSERT_TRUE(found.s >= 0 && found.s <= 1 && found.t >= 0 && found.t <= 1);
  const Vec3d p0 = convert<double>(p[0]), p1 = convert<double>(p[1]), q0 = convert<double>(q[0]),
              q1 = convert<double>(q[1]);
  const Vec3d first = p0 + (p1 - p0) * static_cast<double>(found.s),
              second = q0 + (q1 - q0) * static_cast<double>(found.t);
  expect_near(convert<double>(found.first), first, tolerance);
  expect_near(convert<double>(found.second), second, tolerance);
  const Vec3d apart = second - first;
  ASSERT_NEAR(found.distance_squared, length_squared(apart), tolerance * 10);
  // The points are optimal if and only if no end of either segment is nearer to the other's point, along the line
  // between both.
  double worst = 0;
  for (const Vec3d& end : {p0, p1}) worst = std::max(worst, dot(apart, end - first));
  for (const Vec3d& end : {q0, q1}) worst = std::max(worst, -dot(apart, end - second));
  ASSERT_LE(worst, place_tolerance);
}

TEST(ClosestOnSegments, KnowsCrossingsEndsAndParallels) {
  const Vec3d x[2] = {{-1, 0, 0}, {1, 0, 0}}, z[2] = {{0, 1, -3}, {0, 1, 1}};
  const auto crossing = closest_on_segments(x, z);
  EXPECT_NEAR(crossing.s, 0.5, 1e-12);
  EXPECT_NEAR(crossing.t, 0.75, 1e-12);
  EXPECT_NEAR(crossing.distance_squared, 1, 1e-12);
  const Vec3d beyond[2] = {{4, 4, 0}, {9, 9, 0}};
  const auto ends = closest_on_segments(x, beyond);
  EXPECT_EQ(ends.s, 1);
  EXPECT_EQ(ends.t, 0);
  EXPECT_NEAR(ends.distance_squared, 25, 1e-12);
  const Vec3d parallel[2] = {{0.5, 2, 0}, {7, 2, 0}}, opposite[2] = {{7, 2, 0}, {0.5, 2, 0}},
              apart[2] = {{2, 0, 0}, {3, 0, 0}};
  EXPECT_NEAR(closest_on_segments(x, parallel).distance_squared, 4, 1e-12);
  EXPECT_NEAR(closest_on_segments(x, opposite).distance_squared, 4, 1e-12);
  EXPECT_NEAR(closest_on_segments(x, apart).distance_squared, 1, 1e-12);  // on one line, disjoint
  EXPECT_NEAR(closest_on_segments(x, x).distance_squared, 0, 1e-12);
}

TEST(ClosestOnSegments, TreatsPointsAsSegments) {
  const Vec3d x[2] = {{-1, 0, 0}, {1, 0, 0}}, point[2] = {{0.5, 3, 0}, {0.5, 3, 0}}, other[2] = {{0, 0, 4}, {0, 0, 4}};
  EXPECT_NEAR(closest_on_segments(x, point).s, 0.75, 1e-12);
  EXPECT_NEAR(closest_on_segments(point, x).t, 0.75, 1e-12);
  EXPECT_NEAR(closest_on_segments(point, other).distance_squared, 25.25, 1e-12);
  EXPECT_EQ(closest_on_segments(point, point).distance_squared, 0);
}

TEST(ClosestOnSegments, IsOptimalForRandomAndNearlyParallelPairs) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const auto a = random_point<double>(random), b = random_point<double>(random), c = random_point<double>(random);
    const double turn = std::pow(10.0, -(i % 20));
    const Vec3d p[2] = {a, b}, q[2] = {c, c + (b - a) * (1.0 * (i % 5) - 2) + random_point<double>(random) * turn};
    check_segments(p, q, 1e-13, 1e-10);
    const Vec3f single_p[2] = {convert<float>(p[0]), convert<float>(p[1])};
    const Vec3f single_q[2] = {convert<float>(q[0]), convert<float>(q[1])};
    check_segments(single_p, single_q, 2e-6, 3e-3);
    const Vec3d exact_p[2] = {convert<double>(single_p[0]), convert<double>(single_p[1])};
    const Vec3d exact_q[2] = {convert<double>(single_q[0]), convert<double>(single_q[1])};
    const double exact = closest_on_segments(exact_p, exact_q).distance_squared;
    ASSERT_NEAR(closest_on_segments(single_p, single_q).distance_squared, exact, 5e-6 * (1 + exact));
  }
}

TEST(Triangle, KnowsAreaNormalAndVolume) {
  const Vec3d o{0, 0, 0}, x{3, 0, 0}, y{0, 4, 0}, z{0, 0, 5};
  EXPECT_EQ(triangle_area(o, x, y), 6);
  expect_near(triangle_normal(o, x, y), {0, 0, 1});
  expect_near(triangle_normal(o, y, x), {0, 0, -1});
  EXPECT_NEAR(tetrahedron_volume(o, x, y, z), 10, 1e-12);
  EXPECT_NEAR(tetrahedron_volume(o, y, x, z), -10, 1e-12);
  const Vec3d shift{7, -3, 2};  // the volume of a closed surface does not depend on the origin
  const Vec3d c[4] = {o + shift, x + shift, y + shift, z + shift};
  const double sum = six_volumes(c[0], c[2], c[1]) + six_volumes(c[0], c[1], c[3]) + six_volumes(c[1], c[2], c[3]) +
                     six_volumes(c[2], c[0], c[3]);
  EXPECT_NEAR(sum, 60, 1e-11);
}

TEST(Triangle, WithoutAreaHasNoNormalAndTinyOnesHaveOne) {
  EXPECT_EQ(triangle_normal(Vec3f{1, 2, 3}, Vec3f{1, 2, 3}, Vec3f{1, 2, 3}), (Vec3f{0, 0, 0}));
  EXPECT_EQ(triangle_normal(Vec3f{0, 0, 0}, Vec3f{1, 1, 1}, Vec3f{2, 2, 2}), (Vec3f{0, 0, 0}));
  EXPECT_EQ(triangle_area(Vec3f{0, 0, 0}, Vec3f{1, 1, 1}, Vec3f{2, 2, 2}), 0);
  EXPECT_EQ(triangle_normal(Vec3f{0, 0, 0}, Vec3f{1e-30f, 0, 0}, Vec3f{0, 1e-30f, 0}), (Vec3f{0, 0, 1}));
  EXPECT_EQ(triangle_normal(Vec3f{0, 0, 0}, Vec3f{1e30f, 0, 0}, Vec3f{0, 1e30f, 0}), (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace pliant
