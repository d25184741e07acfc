// Tests distances of convex solids by certificates: the solids lie on two sides of a slab as thick as the separation,
// and the places found lie on both; where they overlap, no sampled direction has a shorter way out.
#include "geometry/convex_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "geometry/polyhedron_contact.h"
#include "math/vector.h"

namespace pliant {
namespace {

using Kind = ConvexShape::Kind;

class RandomPoses {
 public:
  explicit RandomPoses(int seed) : random_(static_cast<std::uint64_t>(seed)) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  Vec3d vector(double range) {
    const double x = number(-range, range), y = number(-range, range), z = number(-range, range);
    return {x, y, z};
  }
  Posed pose(double range) {
    const Vec3d place = vector(range), axis = vector(1);
    return {place, normalise(Quatd{axis.x, axis.y, axis.z, number(-1, 1)})};
  }

 private:
  std::mt19937_64 random_;
};

float real(double value) { return static_cast<float>(value); }

/// Any solid; `boxes` keeps its polyhedron.
ConvexShape draw(RandomPoses& random, Polyhedron& kept) {
  const int kind = static_cast<int>(random.number(0, 5));
  ConvexShape shape;
  shape.kind = static_cast<Kind>(kind);
  const bool has_radius = shape.kind == Kind::point || shape.kind == Kind::segment || random.number(0, 1) < 0.3;
  if (has_radius) shape.radius = real(random.number(0.05, 0.5));
  shape.core_radius = real(random.number(0.1, 0.6));
  shape.half_length = real(random.number(0.1, 0.6));
  kept =
      polyhedron_of_box({real(random.number(0.1, 0.6)), real(random.number(0.1, 0.6)), real(random.number(0.1, 0.6))});
  shape.polyhedron = &kept;
  return shape;
}

double gap_along(const ConvexShape& a, const ConvexShape& b, const Posed& pose, const Vec3d& n) {
  const double highest = dot(n, support(a, n)) + double(a.radius);
  const Vec3d local = rotate(conjugate(pose.rotation), -n);
  return dot(n, to_world(pose, support(b, local))) - double(b.radius) - highest;
}

/// How far a place is from the surface of the solid, at most, measured along many directions.
double outside(const ConvexShape& shape, const Vec3d& place, RandomPoses& random) {
  double most = -1e30;
  for (int i = 0; i < 60; ++i) {
    const Vec3d n = unit_or(random.vector(1), Vec3d{0, 1, 0});
    most = std::max(most, dot(n, place) - dot(n, support(shape, n)) - double(shape.radius));
  }
  return most;
}

TEST(ConvexDistance, IsThatOfASlabBetweenBoth) {
  RandomPoses random(1);
  int apart = 0, overlapping = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Polyhedron first, second;
    const ConvexShape a = draw(random, first), b = draw(random, second);
    const Posed pose = random.pose(1.2);
    const ConvexDistance found = convex_distance(a, b, pose);
    ASSERT_NEAR(length(found.normal), 1, 1e-9) << trial;
    const Vec3d error = found.on_b - found.on_a - found.normal * found.separation;
    ASSERT_LT(length(error), 1e-7) << trial;
    ASSERT_NEAR(gap_along(a, b, pose, found.normal), found.separation, 2e-5) << trial;
    ASSERT_LT(outside(a, found.on_a, random), 1e-6) << trial;
    ASSERT_LT(outside(b, to_local(pose, found.on_b), random), 1e-6) << trial;
    (found.separation > 0 ? apart : overlapping) += 1;
    if (found.separation > 0 || trial % 10 != 0) continue;
    for (int i = 0; i < 300; ++i)
      ASSERT_LT(gap_along(a, b, pose, unit_or(random.vector(1), Vec3d{0, 1, 0})), found.separation + 1e-3) << trial;
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(overlapping, 3000);
}

// Pairs that are farther apart than asked for may be left early, with a lower bound.
TEST(ConvexDistance, IsTheSameWithinReachAndABoundBeyond) {
  RandomPoses random(5);
  int within = 0, bounds = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    Polyhedron first, second;
    const ConvexShape a = draw(random, first), b = draw(random, second);
    const Posed pose = random.pose(1.5);
    const double reach = random.number(0, 0.5), whole = convex_distance(a, b, pose).separation;
    const double found = convex_distance(a, b, pose, reach).separation;
    if (whole <= reach) {
      ++within;
      ASSERT_EQ(found, whole) << trial;
    } else {
      if (found < whole) ++bounds;
      ASSERT_GT(found, reach) << trial;
      ASSERT_LT(found, whole + 1e-7) << trial;
    }
  }
  EXPECT_GT(within, 1000);
  EXPECT_GT(bounds, 1000);
}

TEST(ConvexDistance, OfBoxesIsThatOfSeparatingAxes) {
  RandomPoses random(2);
  int overlapping = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Polyhedron first, second;
    ConvexShape a = draw(random, first), b = draw(random, second);
    a.kind = b.kind = Kind::polyhedron;
    a.radius = b.radius = 0;
    const Posed pose = random.pose(0.8);
    const double found = convex_distance(a, b, pose).separation;
    if (found >= 0) continue;
    ++overlapping;
    ASSERT_NEAR(separating_axis(first, moved(second, convert<float>(pose))).separation, found, 1e-3) << trial;
  }
  EXPECT_GT(overlapping, 500);
}

ConvexShape ball(float radius) { return {Kind::point, radius, 0, 0, nullptr}; }

TEST(ConvexDistance, OfBallsIsThatOfTheirCentres) {
  const ConvexDistance apart = convex_distance(ball(0.5f), ball(0.25f), {{3, 4, 0}, {}});
  EXPECT_NEAR(apart.separation, 5 - 0.75, 1e-7);
  EXPECT_NEAR(apart.normal.x, 0.6, 1e-9);
  EXPECT_NEAR(apart.on_a.x, 0.3, 1e-7);
  const ConvexDistance same = convex_distance(ball(0.5f), ball(0.25f), {});
  EXPECT_NEAR(same.separation, -0.75, 1e-7);
  EXPECT_NEAR(same.normal.y, 1, 1e-9) << "any direction would do; it is always the same";
}

/// Where an axis passes through the other, the way out is across both.
TEST(ConvexDistance, OfCapsulesWithCommonPointsIsAcross) {
  const ConvexShape capsule{Kind::segment, 0.1f, 0, 1, nullptr};
  const Quatd quarter{0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  const ConvexDistance crossed = convex_distance(capsule, capsule, {{}, quarter});
  EXPECT_NEAR(crossed.separation, -0.2, 1e-6);
  EXPECT_NEAR(std::fabs(crossed.normal.z), 1, 1e-9);
  const ConvexDistance on_axis = convex_distance(capsule, ball(0.3f), {{0, 0.5, 0}, {}});
  EXPECT_NEAR(on_axis.separation, -0.4, 1e-6);
  EXPECT_NEAR(on_axis.normal.y, 0, 1e-9);
  EXPECT_NEAR(on_axis.on_a.y, 0.5, 1e-6) << "where the ball is, not at the capsule's end";
  EXPECT_NEAR(crossed.on_a.y, 0, 1e-6);
}

TEST(ConvexDistance, OfACylinderThatStandsOrLiesIsThatToTheFloor) {
  Polyhedron kept = polyhedron_of_box({5, 1, 5});
  const ConvexShape floor{Kind::polyhedron, 0, 0, 0, &kept}, cylinder{Kind::cylinder, 0, 0.3f, 0.5f, nullptr};
  for (const double gap : {0.01, -0.01}) {
    EXPECT_NEAR(convex_distance(floor, cylinder, {{0.1, 1.5 + gap, 0}, {}}).separation, gap, 1e-6);
    const Quatd quarter{0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    EXPECT_NEAR(convex_distance(floor, cylinder, {{0.1, 1.3 + gap, 0}, quarter}).separation, gap, 1e-5);
  }
}

// A prism above the plane of a triangle touches the triangle's edge to the last bit; the polytope then has flat parts.
TEST(ConvexDistance, OfAPrismThatJustTouchesAnEdgeIsZero) {
  Polyhedron triangle, prism;
  triangle.corners = {
      {-0.837153673f, 0, 0.837153673f}, {0.837153673f, 0, 2.51146102f}, {0.837153673f, 0, 0.837153673f}};
  const float r = 0.062642172f, h = 0.0897143558f, k = 0.0442947038f;
  prism.corners = {{r, h, 0},  {k, h, -k}, {0, h, -r},  {-k, h, -k}, {-r, h, 0},   {-k, h, k},
                   {0, h, r},  {k, h, k},  {-k, -h, k}, {-r, -h, 0}, {-k, -h, -k}, {k, -h, k},
                   {0, -h, r}, {r, -h, 0}, {0, -h, -r}, {k, -h, -k}};
  const ConvexShape a{Kind::polyhedron, 0, 0, 0, &triangle}, b{Kind::polyhedron, 0, 0, 0, &prism};
  const Posed pose{{-0.20974124573358474, 0.089710323203863157, 0.77753680270453085},
                   {6.3742870817611322e-12, -0.85318976058376639, 2.3918355490159375e-13, -0.52160064458838207}};
  EXPECT_NEAR(convex_distance(a, b, pose).separation, 0, 1e-12);
}

TEST(ConvexDistance, FeaturesAreTheFlatPartsThatFaceADirection) {
  Polyhedron kept = polyhedron_of_box({1, 2, 3});
  const ConvexShape box{Kind::polyhedron, 0, 0, 0, &kept}, cylinder{Kind::cylinder, 0, 0.3f, 0.5f, nullptr},
      cone{Kind::cone, 0, 0.3f, 0.5f, nullptr};
  EXPECT_EQ(feature_towards(box, {0, 1, 0}, 1e-3).count, 4);
  EXPECT_EQ(feature_towards(box, unit_or(Vec3d{1, 1, 0}, {}), 1e-3).count, 2);
  EXPECT_EQ(feature_towards(box, unit_or(Vec3d{1, 1, 1}, {}), 1e-3).count, 1);
  EXPECT_EQ(feature_towards(cylinder, {0, 1, 0}, 1e-3).count, 8);
  EXPECT_EQ(feature_towards(cylinder, {1, 0, 0}, 1e-3).count, 2);
  EXPECT_EQ(feature_towards(cylinder, {0.8, 0.6, 0}, 1e-3).count, 1);
  EXPECT_EQ(feature_towards(cone, {0, -1, 0}, 1e-3).count, 8);
  EXPECT_EQ(feature_towards(cone, {0, 1, 0}, 1e-3).count, 1);
  EXPECT_EQ(feature_towards(cone, unit_or(Vec3d{1, 0.3, 0}, {}), 1e-3).count, 2) << "a line of its side";
  const Feature top = feature_towards(cylinder, {0, 1, 0}, 1e-3);
  const Vec3d turn = cross(top.points[1] - top.points[0], top.points[2] - top.points[1]);
  EXPECT_GT(dot(turn, top.normal), 0) << "counter-clockwise from outside";
}

}  // namespace
}  // namespace pliant
