// Tests the primitive solids: known answers where formulas break, brute force everywhere else.
#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "geometry/geometry_support.h"

namespace pliant {
namespace {

using testing_support::expect_near;
using testing_support::random_point;

constexpr LocalShape kPlane{ShapeKind::plane, 0, 0, 0};

const std::vector<LocalShape>& shapes() {
  static const std::vector<LocalShape> all = {
      kPlane,
      {ShapeKind::sphere, 0.5f, 0, 0},
      {ShapeKind::sphere, 0, 0, 0},
      {ShapeKind::capsule, 0.25f, 0.5f, 0},
      {ShapeKind::capsule, 0.25f, 0, 0},
      {ShapeKind::capsule, 0, 0.5f, 0},
      {ShapeKind::box, 0.5f, 0.3f, 0.2f},
      {ShapeKind::box, 0.5f, 0, 0.4f},
      {ShapeKind::box, 0, 0, 0},
  };
  return all;
}

void expect_distance(const LocalShape& shape, const Vec3d& p, double distance, const Vec3d& normal) {
  const auto found = signed_distance(shape, p);
  EXPECT_NEAR(found.distance, distance, 1e-7);
  expect_near(found.normal, normal, 1e-7);
  const auto single = signed_distance(shape, convert<float>(p));
  EXPECT_NEAR(single.distance, distance, 1e-6);
  expect_near(single.normal, convert<float>(normal), 1e-6);
}

TEST(SignedDistance, KnowsPlaneSphereAndCapsule) {
  expect_distance(kPlane, {3, 2, 1}, 2, {0, 1, 0});
  expect_distance(kPlane, {3, -2, 1}, -2, {0, 1, 0});
  const LocalShape sphere{ShapeKind::sphere, 0.5f, 0, 0};
  expect_distance(sphere, {0, 0, -2}, 1.5, {0, 0, -1});
  expect_distance(sphere, {0.1, 0, 0}, -0.4, {1, 0, 0});
  expect_distance(sphere, {0, 0, 0}, -0.5, {0, 1, 0});
  const LocalShape capsule{ShapeKind::capsule, 0.25f, 0.5f, 0};
  expect_distance(capsule, {1, 0.3, 0}, 0.75, {1, 0, 0});
  expect_distance(capsule, {0, 2, 0}, 1.25, {0, 1, 0});
  expect_distance(capsule, {0, -0.7, 0}, -0.05, {0, -1, 0});
  expect_distance(capsule, {0, 0.5, 0.3}, 0.05, {0, 0, 1});
  expect_distance(capsule, {0, 0, 0}, -0.25, {1, 0, 0});
  expect_distance(capsule, {0, 0.5, 0}, -0.25, {1, 0, 0});
}

TEST(SignedDistance, KnowsTheBoxAtFacesEdgesCornersAndWithin) {
  const LocalShape box{ShapeKind::box, 1, 2, 3};
  expect_distance(box, {2, 0, 0}, 1, {1, 0, 0});
  expect_distance(box, {-1, 0, 0}, 0, {-1, 0, 0});
  expect_distance(box, {0, 0, -4}, 1, {0, 0, -1});
  expect_distance(box, {2, 3, 0}, std::sqrt(2.0), {std::sqrt(0.5), std::sqrt(0.5), 0});
  expect_distance(box, {-2, 3, -4}, std::sqrt(3.0), {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0), -1 / std::sqrt(3.0)});
  expect_distance(box, {0, 1.5, 0}, -0.5, {0, 1, 0});
  expect_distance(box, {0, 0, -2.5}, -0.5, {0, 0, -1});
  expect_distance(box, {0, 0, 0}, -1, {1, 0, 0});
  expect_distance(box, {1, 2, 3}, 0, {1, 0, 0});
  expect_distance(box, {0.5, 1.5, 0}, -0.5, {1, 0, 0});
}

TEST(SignedDistance, HasAUnitNormalAndIsItsOwnGradientEverywhere) {
  std::mt19937_64 random(1);
  for (const LocalShape& shape : shapes()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p = random_point(random, i % 2 == 0 ? 1.0 : 0.3);
      const auto at = signed_distance(shape, p);
      ASSERT_NEAR(length(at.normal), 1, 1e-12);
      ASSERT_NEAR(length(signed_distance(shape, convert<float>(p)).normal), 1, 1e-6);
      const auto near = signed_distance(shape, p + at.normal * 1e-7);
      ASSERT_NEAR(near.distance - at.distance, 1e-7, 1e-12);  // the distance grows at a rate of one along the normal
      const auto surface = signed_distance(shape, p - at.normal * at.distance);
      ASSERT_NEAR(surface.distance, 0, 1e-12);  // the closest surface point
    }
  }
}

TEST(SignedDistance, IsFiniteAtTheMedialAxisAndFarAway) {
  for (const LocalShape& shape : shapes()) {
    for (const float size : {0.f, 1e-45f, 1e-30f, 1e-19f, 1e-7f, 1.f, 1e9f, 1e18f}) {
      for (const Vec3f& direction : {Vec3f{1, 0, 0}, Vec3f{0, -1, 0}, Vec3f{0, 0, 1}, Vec3f{1, -1, 1}}) {
        const auto found = signed_distance(shape, direction * size);
        EXPECT_TRUE(std::isfinite(found.distance));
        EXPECT_NEAR(length(found.normal), 1, 1e-6) << static_cast<int>(shape.kind) << " " << size;
      }
    }
  }
}

/// The first of `count` + 1 sampled positions along the path that is within the margin; none if there is none.
double march(const LocalShape& shape, const Vec3d& a, const Vec3d& b, double margin, int count) {
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    if (signed_distance(shape, a + (b - a) * t).distance <= margin) return t;
  }
  return -1;
}

TEST(FirstHit, AgreesWithMarching) {
  std::mt19937_64 random(2);
  int hits = 0, misses = 0;
  for (const LocalShape& shape : shapes()) {
    for (const double margin : {0.0, 0.01, 0.2}) {
      for (int i = 0; i < 150; ++i) {
        const Vec3d a = random_point(random, 1.5), b = random_point(random, 1.5);
        const auto found = first_hit(shape, a, b, margin);
        const double marched = march(shape, a, b, margin, 1000);
        const auto single = first_hit(shape, convert<float>(a), convert<float>(b), static_cast<float>(margin));
        if (marched >= 0) {
          ASSERT_TRUE(found.hit);
          ASSERT_LE(found.t,
                    marched + 1e-12);  // sampling can only be late, and by at most a step unless the path grazes
          if (found.t > 0) {           // the position is at the margin, and no earlier one is nearer
            ASSERT_NEAR(signed_distance(shape, a + (b - a) * found.t).distance, margin, 1e-9);
            ASSERT_EQ(march(shape, a, a + (b - a) * found.t, margin - 1e-9, 200), -1);
          }
          ++hits;
        } else {
          if (found.hit) {  // between two samples
            ASSERT_NEAR(found.distance, margin, 1e-12);
          }
          ++misses;
        }
        if (single.hit != found.hit) {  // only where the path grazes
          double least = 1e9;
          for (int k = 0; k <= 1000; ++k)
            least = std::min(least, signed_distance(shape, a + (b - a) * (k / 1000.0)).distance);
          ASSERT_NEAR(least, margin, 2e-5);
        } else if (found.hit) {
          ASSERT_NEAR(signed_distance(shape, convert<double>(single.point)).distance, found.distance, 1e-6);
        }
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(misses, 300);
}

TEST(FirstHit, KnowsPlainCases) {
  const LocalShape sphere{ShapeKind::sphere, 1, 0, 0};
  const auto hit = first_hit(sphere, Vec3d{0, 5, 0}, Vec3d{0, -5, 0}, 0.5);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.t, 0.35, 1e-12);
  expect_near(hit.point, Vec3d{0, 1.5, 0}, 1e-12);
  expect_near(hit.normal, Vec3d{0, 1, 0}, 1e-12);
  EXPECT_NEAR(hit.distance, 0.5, 1e-12);
  EXPECT_FALSE(first_hit(sphere, Vec3d{0, 5, 0}, Vec3d{0, 1.51, 0}, 0.5).hit);  // stops short
  EXPECT_FALSE(first_hit(sphere, Vec3d{0, 2, 0}, Vec3d{0, 9, 0}, 0.5).hit);     // moves away
  EXPECT_TRUE(first_hit(sphere, Vec3d{0, 5, 0}, Vec3d{0, 1.5, 0}, 0.5).hit);    // reaches it at the very end
  const auto rounded = first_hit(LocalShape{ShapeKind::box, 1, 1, 1}, Vec3d{4, 4, 4}, Vec3d{0, 0, 0}, 0.3);
  ASSERT_TRUE(rounded.hit);  // a corner is hit on the ball around it, not on the grown box
  EXPECT_NEAR(rounded.point.x, 1 + 0.3 / std::sqrt(3.0), 1e-12);
  const auto top = first_hit(kPlane, Vec3d{0, 1, 0}, Vec3d{8, -1, 0}, 0.0);
  ASSERT_TRUE(top.hit);
  expect_near(top.point, Vec3d{4, 0, 0}, 1e-12);
}

TEST(FirstHit, GrazesWithinRounding) {
  const LocalShape sphere{ShapeKind::sphere, 1, 0, 0};
  const auto touching = first_hit(sphere, Vec3d{-3, 1, 0}, Vec3d{3, 1, 0}, 0.0);
  ASSERT_TRUE(touching.hit);
  expect_near(touching.normal, Vec3d{0, 1, 0}, 1e-6);
  EXPECT_TRUE(first_hit(sphere, Vec3d{-3, 0.999999, 0}, Vec3d{3, 0.999999, 0}, 0.0).hit);
  EXPECT_FALSE(first_hit(sphere, Vec3d{-3, 1.000001, 0}, Vec3d{3, 1.000001, 0}, 0.0).hit);
  EXPECT_FALSE(first_hit(sphere, Vec3f{-3, 1.00001f, 0}, Vec3f{3, 1.00001f, 0}, 0.f).hit);
  EXPECT_TRUE(first_hit(sphere, Vec3f{-3, 0.99999f, 0}, Vec3f{3, 0.99999f, 0}, 0.f).hit);
  const LocalShape box{ShapeKind::box, 1, 1, 1};
  EXPECT_FALSE(first_hit(box, Vec3d{-3, 1.0001, 0}, Vec3d{3, 1.0001, 0}, 0.0).hit);  // along a face
  EXPECT_TRUE(first_hit(box, Vec3d{0, 3, 0}, Vec3d{2, -1, 0}, 0.0).hit);             // through an edge exactly
  EXPECT_TRUE(first_hit(box, Vec3d{3, 3, 3}, Vec3d{1, 1, 1}, 0.0).hit);              // onto a corner
}

TEST(FirstHit, TreatsPathsOfNoLengthAndStartsInside) {
  for (const LocalShape& shape : shapes()) {
    const Vec3d outside{3, 3, 3}, inside{0, 0, 0};
    EXPECT_FALSE(first_hit(shape, outside, outside, 0.1).hit);
    const auto at_rest = first_hit(shape, inside, inside, 0.1);
    EXPECT_TRUE(at_rest.hit);
    EXPECT_EQ(at_rest.t, 0);
    const auto leaving = first_hit(shape, inside, outside, 0.1);
    EXPECT_TRUE(leaving.hit);
    EXPECT_EQ(leaving.t, 0);
    EXPECT_NEAR(length(leaving.normal), 1, 1e-12);
    EXPECT_EQ(leaving.distance, signed_distance(shape, inside).distance);
  }
}

TEST(FirstHit, NothingTunnelsAtAnySpeed) {
  // Every path goes through the shape's centre, so each must hit, on the side from which it comes.
  std::mt19937_64 random(3);
  const std::vector<LocalShape> thin = {{ShapeKind::box, 0.5f, 1e-6f, 0.5f},   {ShapeKind::box, 0.5f, 0, 0.5f},
                                        {ShapeKind::sphere, 0.001f, 0, 0},     {ShapeKind::capsule, 0.001f, 0.5f, 0},
                                        {ShapeKind::box, 1e-3f, 1e-3f, 1e-3f}, kPlane};
  for (const LocalShape& shape : thin) {
    for (const float speed : {0.1f, 1.f, 100.f, 1e4f, 1e6f, 1e9f}) {
      for (int i = 0; i < 300; ++i) {
        const Vec3f a = convert<float>(random_point(random, 1));
        if (a.y < 0.05f) continue;
        const float scale = speed / length(a) + 0.01f;
        const auto found = first_hit(shape, a, a * -scale, 0.0001f);
        ASSERT_TRUE(found.hit) << static_cast<int>(shape.kind) << " " << shape.b << " speed " << speed;
        ASSERT_GT(dot(found.normal, a), 0);
        ASSERT_LE(found.distance, 0.00011f + 1e-6f);
        ASSERT_GE(found.distance, -1e-6f);
      }
    }
  }
}

TEST(FirstHit, SheetsWithoutThicknessAreNotMissed) {
  std::mt19937_64 random(4);
  const LocalShape sheet{ShapeKind::box, 1, 0, 1};
  for (int i = 0; i < 20000; ++i) {
    Vec3f a = convert<float>(random_point(random, 1)), b = convert<float>(random_point(random, 1));
    a.y = std::fabs(a.y) + 1e-3f;
    b.y = -std::fabs(b.y) - 1e-3f;
    const auto found = first_hit(sheet, a, b, 0.f);
    ASSERT_TRUE(found.hit);
    ASSERT_GT(found.normal.y, 0.999f);
  }
}

TEST(FirstHit, RefusesWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const LocalShape& shape : shapes()) {
    for (const float bad : {nan, infinity, -infinity, 3e38f}) {
      for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{bad, bad, bad}}) {
        EXPECT_FALSE(first_hit(shape, p, Vec3f{0, 0, 0}, 0.1f).hit && std::isfinite(p.x) && std::isfinite(p.y));
        EXPECT_FALSE(first_hit(shape, p, p, 0.1f).hit && !std::isfinite(p.x + p.y));
        EXPECT_FALSE(first_hit(shape, Vec3f{2, 2, 2}, p, 0.1f).hit);
      }
    }
  }
}

TEST(Bounds, HoldTheShapeAndAreTight) {
  std::mt19937_64 random(5);
  for (const LocalShape& shape : shapes()) {
    if (shape.kind == ShapeKind::plane) continue;
    for (int i = 0; i < 20; ++i) {
      const Vec3d axis = random_point(random, 1);
      const Posef pose{
          convert<float>(random_point(random, 100)),
          normalise(Quatf{static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z), 0.3f})};
      const auto box = bounding_box(shape, pose, 0.05f);
      const auto ball = bounding_sphere(shape, pose, 0.05f);
      Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
      for (int k = 0; k < 4000; ++k) {  // surface points of the grown shape
        Vec3d p = random_point(random, 2);
        const auto at = signed_distance(shape, p);
        p -= at.normal * (at.distance - 0.05);
        const Vec3d world = to_world(convert<double>(pose), p);
        low = min(low, world), high = max(high, world);
        ASSERT_LE(length(world - convert<double>(ball.centre)), ball.radius);
      }
      const Vec3d slack_low = low - convert<double>(box.low), slack_high = convert<double>(box.high) - high;
      for (const double slack : {slack_low.x, slack_low.y, slack_low.z, slack_high.x, slack_high.y, slack_high.z}) {
        ASSERT_GE(slack, 0);
        ASSERT_LE(slack, 0.3);
      }
    }
  }
  const Posef upright{{1, 2, 3}, {}};
  const auto tight = bounding_box(LocalShape{ShapeKind::box, 1, 2, 3}, upright, 0.f);
  expect_near(tight.low, Vec3f{0, 0, 0}, 1e-4);
  expect_near(tight.high, Vec3f{2, 4, 6}, 1e-4);
  EXPECT_EQ(bounding_sphere(kPlane, upright, 0.f).radius, std::numeric_limits<float>::infinity());
  EXPECT_EQ(bounding_box(kPlane, upright, 0.f).low.x, -std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace pliant
