// Compares the closest point of a segment to a primitive solid with many sampled points in double precision.
#include "geometry/shape_closest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pliant {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}

template <class R>
Vec3<R> place(std::mt19937& random, double range) {
  const double x = uniform(random, -range, range), y = uniform(random, -range, range),
               z = uniform(random, -range, range);
  return convert<R>(Vec3d{x, y, z});
}

LocalShape some_shape(std::mt19937& random, int round) {
  const auto size = [&](double low) { return static_cast<float>(uniform(random, low, 1)); };
  if (round % 3 == 0) return {ShapeKind::sphere, size(0.01), 0, 0};
  if (round % 3 == 1) return {ShapeKind::capsule, size(0.01), size(0), 0};
  const float a = size(0.01), b = size(0.01), c = size(0.01);
  return {ShapeKind::box, a, b, c};
}

/// The least distance of sampled points on a segment, sampled more finely near the least.
double least_of_many(const LocalShape& shape, const Vec3d& a, const Vec3d& b) {
  double low = 0, high = 1, least = 1e30;
  for (int round = 0; round < 4; ++round) {
    double best = low;
    for (int i = 0; i <= 100; ++i) {
      const double t = low + (high - low) * i / 100, distance = signed_distance(shape, a + (b - a) * t).distance;
      if (distance < least) best = t;
      least = std::min(least, distance);
    }
    const double width = (high - low) / 50;
    low = std::max(0.0, best - width);
    high = std::min(1.0, best + width);
  }
  return least;
}

template <class R>
class ClosestToShapes : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ClosestToShapes, Precisions);

TYPED_TEST(ClosestToShapes, IsTheLeastOfManyPlaces) {
  using R = TypeParam;
  std::mt19937 random(5);
  int dipping = 0;
  for (int round = 0; round < 6000; ++round) {
    const LocalShape shape = some_shape(random, round);
    const Vec3<R> a = place<R>(random, 2), b = place<R>(random, 2);
    const SegmentNearShape<R> segment(shape, a, b);
    const double exact = 1e-5 * static_cast<double>(length(b - a)) + 1e-6;
    const double least = least_of_many(shape, convert<double>(a), convert<double>(b));
    if (!segment.dips()) {
      EXPECT_NEAR(static_cast<double>(std::min(segment.at_a.distance, segment.at_b.distance)), least, exact) << round;
      continue;
    }
    ++dipping;
    EXPECT_LE(static_cast<double>(segment.lower_bound()), least + exact) << round;
    const ClosestToShape<R> closest = closest_between(segment);
    EXPECT_NEAR(static_cast<double>(length(closest.normal)), 1, 1e-5) << round;
    if (least < 0) {  // inside, where two faces meet, the measured distance is that to their edge, which is longer
      EXPECT_LE(static_cast<double>(closest.distance), least + exact) << round;
      continue;
    }
    EXPECT_NEAR(static_cast<double>(closest.distance), least, exact) << round;
    EXPECT_NEAR(static_cast<double>(dot(closest.normal, segment.edge) / length(segment.edge)), 0, 1e-3) << round;
  }
  EXPECT_GT(dipping, 1500);
}

TEST(ClosestToShape, InsideABoxIsItsEdge) {
  const LocalShape box{ShapeKind::box, 1, 1, 1};
  // Across the edge x = y = 1, which is 0.1 sqrt(2) away from the segment's middle.
  const SegmentNearShape<float> segment(box, {1.3f, 0.5f, 0}, {0.5f, 1.3f, 0});
  ASSERT_TRUE(segment.dips());
  const ClosestToShape<float> closest = closest_between(segment);
  EXPECT_NEAR(closest.t, 0.5f, 1e-5f);
  EXPECT_NEAR(closest.distance, -0.1f * std::sqrt(2.f), 1e-5f);
  EXPECT_NEAR(closest.normal.x, std::sqrt(0.5f), 1e-3f);
  EXPECT_NEAR(closest.normal.y, std::sqrt(0.5f), 1e-3f);
}

TEST(ClosestToShape, BothEndsOfWhatLiesAcross) {
  const LocalShape box{ShapeKind::box, 0.25f, 1, 1}, capsule{ShapeKind::capsule, 0.1f, 0.25f, 0};
  const ClosestStretch<float> across = closest_stretch(SegmentNearShape<float>(box, {-1, 1.01f, 0}, {1, 1.01f, 0}));
  const ClosestStretch<float> along = closest_stretch(SegmentNearShape<float>(capsule, {0.11f, -1, 0}, {0.11f, 1, 0}));
  for (const ClosestStretch<float>& stretch : {across, along}) {
    ASSERT_EQ(stretch.places, 2);
    EXPECT_NEAR(stretch.place[0].t, 0.375f, 0.003f);
    EXPECT_NEAR(stretch.place[1].t, 0.625f, 0.003f);
    EXPECT_NEAR(stretch.place[0].distance, 0.01f, 1e-4f);
    EXPECT_NEAR(stretch.place[1].distance, 0.01f, 1e-4f);
  }
  const LocalShape sphere{ShapeKind::sphere, 0.1f, 0, 0};
  EXPECT_EQ(closest_stretch(SegmentNearShape<float>(sphere, {-1, 0.11f, 0}, {1, 0.11f, 0})).places, 1);
}

}  // namespace
}  // namespace pliant
