// Tests rotations and keyframed motions with angles and positions that can be checked by hand.
#include "math/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pliant/error.h"

namespace pliant {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Quatd random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random), w = normal(random);
  return normalise(Quatd{x, y, z, w});
}

Keyframe key(float time, const Vec3f& position, const Quatf& turn = {}) { return {time, position, turn}; }

TEST(Quat, TurnsTheAxesIntoOneAnother) {
  const Quatf about_y = rotation({0, 2, 0}, 90);  // the axis need not be of unit length
  expect_near(convert<double>(rotate(about_y, Vec3f{0, 0, 1})), {1, 0, 0}, 1e-7);
  expect_near(convert<double>(rotate(about_y, Vec3f{1, 0, 0})), {0, 0, -1}, 1e-7);
  expect_near(convert<double>(rotate(about_y, Vec3f{0, 1, 0})), {0, 1, 0}, 1e-7);
  EXPECT_EQ(rotation({1, 0, 0}, 180), (Quatf{1, 0, 0, 0}));
  EXPECT_EQ(rotation({0, 0, -3}, 180), (Quatf{0, 0, -1, 0}));
  EXPECT_EQ(rotation({1, 2, 3}, 0), (Quatf{}));
  EXPECT_EQ(rotation({1, 0, 0}, 360), (Quatf{0, 0, 0, -1}));  // the same rotation as none
  EXPECT_NEAR(rotation({1, 1, 1}, 120).x, 0.5f, 1e-7);
  EXPECT_EQ(rotation({1e-30f, 0, 0}, 180), (Quatf{1, 0, 0, 0}));
  EXPECT_EQ(rotation({3e38f, 0, 0}, 180), (Quatf{1, 0, 0, 0}));
}

TEST(Quat, RefusesAnAxisWithoutDirection) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_THROW(rotation({0, 0, 0}, 90), Error);
  EXPECT_THROW(rotation({nan, 0, 1}, 90), Error);
  EXPECT_THROW(rotation({infinity, 0, 1}, 90), Error);
  EXPECT_THROW(rotation({0, 0, 1}, nan), Error);
  EXPECT_THROW(rotation({0, 0, 1}, infinity), Error);
}

TEST(Quat, ProductConjugateAndLengthAreAsAlgebraSays) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Quatd a = random_rotation(random), b = random_rotation(random);
    const Vec3d v{1, -2, 3};
    expect_near(rotate(multiply(a, b), v), rotate(a, rotate(b, v)));
    expect_near(rotate(conjugate(a), rotate(a, v)), v);
    EXPECT_NEAR(length(rotate(a, v)), length(v), 1e-12);
    expect_near(cross(rotate(a, v), rotate(a, Vec3d{0, 1, 0})), rotate(a, cross(v, Vec3d{0, 1, 0})));  // no mirror
    const Posed outer{{1, 2, 3}, a}, inner{{-2, 0, 5}, b};
    expect_near(to_world(compose(outer, inner), v), to_world(outer, to_world(inner, v)));
    expect_near(to_local(outer, to_world(outer, v)), v);
  }
  EXPECT_EQ(normalise(Quatf{0, 0, 0, 0}), (Quatf{}));
  EXPECT_EQ(normalise(Quatf{0, 3, 0, 0}), (Quatf{0, 1, 0, 0}));
}

TEST(Quat, InterpolatesAlongTheShorterArcAtEvenSpeed) {
  const Quatd start{}, end = convert<double>(rotation({0, 0, 1}, 160));
  for (const double sign : {1.0, -1.0}) {  // q and -q are the same rotation
    const Quatd other{sign * end.x, sign * end.y, sign * end.z, sign * end.w};
    for (double share = 0; share <= 1; share += 0.125) {
      const Quatd at = slerp(start, other, share);
      EXPECT_NEAR(2 * std::atan2(at.z, at.w) * 180 / std::acos(-1.0), 160 * share, 1e-5);
      EXPECT_NEAR(dot(at, at), 1, 1e-15);
    }
    const Quatd middle = nlerp(start, other, 0.5);
    EXPECT_NEAR(2 * std::atan2(middle.z, middle.w) * 180 / std::acos(-1.0), 80, 1e-5);
  }
}

TEST(Quat, InterpolatesBetweenNearlyEqualAndOppositeRotations) {
  for (const double angle : {0.0, 1e-300, 1e-16, 1e-9, 1e-6, 2e-6}) {
    const Quatd end = normalise(Quatd{0, angle / 2, 0, 1});
    EXPECT_NEAR(slerp(Quatd{}, end, 0.5).y, angle / 4, 1e-16 + angle * 1e-9);
  }
  const Quatd half_turn{1, 0, 0, 0};  // neither arc is shorter; any direction will do, but the result must be half-way
  EXPECT_NEAR(std::fabs(slerp(Quatd{}, half_turn, 0.5).x), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(slerp(Quatd{}, half_turn, 0.5).w, std::sqrt(0.5), 1e-12);
  const Quatd same = slerp(half_turn, Quatd{-1, 0, 0, 0}, 0.3);  // the same rotation with another sign
  EXPECT_NEAR(std::fabs(same.x), 1, 1e-12);
}

TEST(Motion, StandsStillWithoutKeyframesAndHoldsAtItsEnds) {
  expect_near(pose_at(Motion{}, 7).position, {0, 0, 0});
  const Motion motion{{key(1, {1, 0, 0}), key(3, {5, 2, 0})}, {}, false};
  expect_near(pose_at(motion, -10).position, {1, 0, 0});
  expect_near(pose_at(motion, 1).position, {1, 0, 0});
  expect_near(pose_at(motion, 1.5).position, {2, 0.5, 0});
  expect_near(pose_at(motion, 3).position, {5, 2, 0});
  expect_near(pose_at(motion, 1e9).position, {5, 2, 0});
  const Motion single{{key(2, {0, 4, 0}, rotation({0, 1, 0}, 90))}, {}, true};
  for (const double time : {-1.0, 2.0, 50.0})
    expect_near(to_world(pose_at(single, time), Vec3d{1, 0, 0}), {0, 4, -1}, 1e-7);
}

TEST(Motion, FindsItsKeyframesAmongMany) {
  Motion motion;
  for (int i = 0; i <= 100; ++i)
    motion.keyframes.push_back(key(static_cast<float>(i * i), {static_cast<float>(i), 0, 0}));
  for (int i = 0; i < 100; ++i) {
    expect_near(pose_at(motion, i * i).position, {static_cast<double>(i), 0, 0});
    expect_near(pose_at(motion, i * i + i + 0.5).position, {i + 0.5, 0, 0});
  }
}

TEST(Motion, Repeats) {
  const Motion motion{{key(1, {0, 0, 0}), key(2, {1, 0, 0}), key(5, {4, 0, 0})}, {}, true};
  expect_near(pose_at(motion, 0.5).position, {0, 0, 0});
  expect_near(pose_at(motion, 5).position, {4, 0, 0});  // the last keyframe itself is reached
  for (int cycle = 0; cycle < 1000; cycle += 7) {
    expect_near(pose_at(motion, 3.5 + 4 * cycle).position, {2.5, 0, 0}, 1e-9);
    expect_near(pose_at(motion, 5.25 + 4 * cycle).position, {0.25, 0, 0}, 1e-9);
  }
}

TEST(Motion, TurnsAboutItsPivot) {
  const Motion motion{{key(0, {0, 0, 0}), key(2, {0, 0, 6}, rotation({0, 0, 1}, 90))}, {1, 1, 0}, false};
  expect_near(to_world(pose_at(motion, 2), Vec3d{1, 1, 0}), {1, 1, 6}, 1e-7);  // the pivot only translates
  expect_near(to_world(pose_at(motion, 2), Vec3d{3, 1, 0}), {1, 3, 6}, 1e-7);
  expect_near(to_world(pose_at(motion, 1), Vec3d{3, 1, 0}), {1 + std::sqrt(2.0), 1 + std::sqrt(2.0), 3}, 1e-7);
  EXPECT_EQ(carried(pose_at(motion, 0), Vec3f{0.1f, 0.2f, 0.3f}), (Vec3f{0.1f, 0.2f, 0.3f}));  // exact at rest
}

TEST(Motion, GivesSomePoseWhateverItsKeyframes) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Motion same_time{{key(1, {1, 0, 0}), key(1, {2, 0, 0})}, {}, true};
  const Motion backwards{{key(3, {1, 0, 0}), key(1, {2, 0, 0}), key(2, {3, 0, 0})}, {}, true};
  const Motion without_rotation{{key(0, {1, 0, 0}, {0, 0, 0, 0}), key(1, {2, 0, 0}, {0, 0, 0, 0})}, {}, true};
  for (const double time : {-1.0, 0.0, 1.0, 1.5, 2.0, 1e300, static_cast<double>(nan)}) {
    for (const Motion& motion : {same_time, backwards, without_rotation}) {
      EXPECT_NEAR(dot(pose_at(motion, time).rotation, pose_at(motion, time).rotation), 1, 1e-12) << time;
    }
  }
}

TEST(Times, HoldAMomentBetweenTwo) {
  const std::vector<float> times{1, 2, 4};
  const auto expect = [&](bool repeat, double time, std::size_t before, std::size_t after, double share) {
    const TimePlace at = place_in(times, repeat, time);
    EXPECT_EQ(at.before, before) << time;
    EXPECT_EQ(at.after, after) << time;
    EXPECT_NEAR(at.share, share, 1e-12) << time;
  };
  expect(false, 0.5, 0, 0, 0);
  expect(false, 1, 0, 1, 0);
  expect(false, 1.25, 0, 1, 0.25);
  expect(false, 3.5, 1, 2, 0.75);
  expect(false, 4, 2, 2, 0);
  expect(false, 9, 2, 2, 0);
  expect(true, 0.5, 0, 0, 0);
  expect(true, 4.25, 0, 1, 0.25);
  expect(true, 9.5, 1, 2, 0.75);
  EXPECT_EQ(place_in({3}, true, 17).after, 0u);
}

}  // namespace
}  // namespace pliant
