// Tests contact points of convex solids of every kind with known ones, and random ones by what must hold for all.
#include "geometry/convex_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/convex_distance.h"
#include "math/vector.h"

namespace pliant {
namespace {

using Kind = ConvexShape::Kind;

const Quatd quarter_turn{0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // about z: a thing along y lies along x

class Contact : public testing::Test {
 protected:
  Polyhedron slab_ = polyhedron_of_box({5, 1, 5});
  ConvexShape floor_{Kind::polyhedron, 0, 0, 0, &slab_};

  /// The contact of something on the floor, 1 mm deep.
  Touch on_floor(const ConvexShape& shape, double height, const Quatd& turned = {}) {
    return touch(floor_, shape, {{0.2, 1 + height - 0.001, 0.3}, turned}, 0.01);
  }
};

void expect_all_at(const Touch& found, int count, double separation) {
  ASSERT_EQ(found.count, count);
  EXPECT_NEAR(found.normal.y, 1, 1e-6);
  for (int i = 0; i < found.count; ++i) {
    EXPECT_NEAR(found.points[i].separation, separation, 1e-5);
    EXPECT_NEAR(found.points[i].on_a.y, 1, 1e-5);
  }
}

double widest(const Touch& found) {
  double most = 0;
  for (int i = 0; i < found.count; ++i)
    for (int j = 0; j < i; ++j) most = std::max(most, length(found.points[i].on_a - found.points[j].on_a));
  return most;
}

TEST_F(Contact, ABallTouchesAtOnePoint) {
  const Touch found = on_floor({Kind::point, 0.5f, 0, 0, nullptr}, 0.5);
  expect_all_at(found, 1, -0.001);
  EXPECT_NEAR(found.points[0].on_b.x, 0.2, 1e-6);
}

TEST_F(Contact, ACapsuleTouchesAtOnePointStandingAndTwoLying) {
  const ConvexShape capsule{Kind::segment, 0.1f, 0, 0.4f, nullptr};
  expect_all_at(on_floor(capsule, 0.5), 1, -0.001);
  const Touch lying = on_floor(capsule, 0.1, quarter_turn);
  expect_all_at(lying, 2, -0.001);
  EXPECT_NEAR(widest(lying), 0.8, 1e-5);
}

/// Half of it lies beyond the edge, below which it is tilted by 0.04 degrees: perpendicular to it is no direction of
/// its own, else it would slide down flush solids.
TEST_F(Contact, ACapsuleAcrossAnEdgeTouchesAlongTheFacesNormal) {
  const ConvexShape capsule{Kind::segment, 0.1f, 0, 0.4f, nullptr};
  const double half_tilt = 0.35e-3;
  const Quatd turned = multiply(Quatd{0, 0, -std::sin(half_tilt), std::cos(half_tilt)}, quarter_turn);
  const Touch across = touch(floor_, capsule, {{5, 1.0999, 0.3}, turned}, 0.01);
  ASSERT_GE(across.count, 1);
  EXPECT_NEAR(across.normal.x, 0, 1e-9);
}

/// With the slack of what moves fast, a tilted cylinder touches with its whole disc, an octagon, between whose corners
/// is the lowest place of the rim.
TEST_F(Contact, ATiltedCylinderTouchesWhereItsRimIsLowest) {
  const ConvexShape cylinder{Kind::cylinder, 0, 0.3f, 0.5f, nullptr};
  for (const double tilt : {0.03, 0.08, 0.15})
    for (const double heading : {0.1, 0.3, 0.39}) {
      const Quatd turned = multiply(Quatd{0, 0, std::sin(tilt / 2), std::cos(tilt / 2)},
                                    Quatd{0, std::sin(heading / 2), 0, std::cos(heading / 2)});
      const Touch found = touch(floor_, cylinder, {{0, 1.6, 0}, turned}, 0.2, 0.3);
      double deepest = 1;
      for (int i = 0; i < found.count; ++i) deepest = std::min(deepest, found.points[i].separation);
      const double lowest = 0.6 - 0.5 * std::cos(tilt) - double(0.3f) * std::sin(tilt);
      EXPECT_NEAR(deepest, lowest, 1e-3) << tilt << ", " << heading;
      const Touch on_plane = touch_half_space(cylinder, {{0, 0.6, 0}, turned}, 0.2, 0.3);
      deepest = 1;
      for (int i = 0; i < on_plane.count; ++i) deepest = std::min(deepest, on_plane.points[i].separation);
      EXPECT_NEAR(deepest, lowest, 1e-3) << "on a plane, " << tilt << ", " << heading;
    }
}

TEST_F(Contact, ACylinderTouchesAtFourPointsStandingAndTwoLying) {
  const ConvexShape cylinder{Kind::cylinder, 0, 0.3f, 0.5f, nullptr};
  const Touch standing = on_floor(cylinder, 0.5);
  expect_all_at(standing, 4, -0.001);
  EXPECT_NEAR(widest(standing), 0.6, 1e-5);
  const Touch lying = on_floor(cylinder, 0.3, quarter_turn);
  expect_all_at(lying, 2, -0.001);
  EXPECT_NEAR(widest(lying), 1, 1e-5);
}

TEST_F(Contact, AConeTouchesAtFourPointsOnItsBaseAndTwoOnItsSide) {
  const double r = 0.3, h = 0.5, slant = std::sqrt(r * r + 4 * h * h);
  const ConvexShape cone{Kind::cone, 0, 0.3f, 0.5f, nullptr};
  expect_all_at(on_floor(cone, 0.5), 4, -0.001);
  const double tilt = -std::acos(-1) / 2 - std::atan2(r, 2 * h);  // brings the outline at +x down
  const Quatd turned{0, 0, std::sin(tilt / 2), std::cos(tilt / 2)};
  const Touch lying = on_floor(cone, h * r / slant, turned);
  expect_all_at(lying, 2, -0.001);
  EXPECT_NEAR(widest(lying), slant, 1e-4);
}

TEST_F(Contact, AHullWithAMarginTouchesAtItsFace) {
  const Polyhedron box = polyhedron_of_box({0.3f, 0.2f, 0.1f});
  expect_all_at(on_floor({Kind::polyhedron, 0.05f, 0, 0, &box}, 0.25), 4, -0.001);
}

/// A hull whose frame is at one of its corners touches like any other.
TEST_F(Contact, AHullsFrameDoesNotMatter) {
  const Polyhedron cornered = moved(polyhedron_of_box({0.5f, 0.5f, 0.5f}), {{0.5f, 0.5f, 0.5f}, {}});
  const ConvexShape box{Kind::polyhedron, 0, 0, 0, &cornered}, cylinder{Kind::cylinder, 0, 0.4f, 0.5f, nullptr};
  const Quatd tilted{0.0005, 0, 0, 1};
  EXPECT_EQ(touch(cylinder, box, {{-0.5, 0.499, -0.5}, normalise(tilted)}, 0.01).count, 4);
}

TEST_F(Contact, WhatHangsOverTouchesOnlyAbove) {
  const ConvexShape cylinder{Kind::cylinder, 0, 0.3f, 0.5f, nullptr};
  const Touch found = touch(floor_, cylinder, {{4.9, 1.3, 0}, quarter_turn}, 0.01);
  ASSERT_EQ(found.count, 2);
  EXPECT_NEAR(widest(found), 0.6, 1e-5) << "from 4.4 to the slab's end at 5";
}

TEST_F(Contact, ParallelCapsulesTouchWhereTheyLieSideBySide) {
  const ConvexShape capsule{Kind::segment, 0.1f, 0, 0.5f, nullptr};
  const Touch found = touch(capsule, capsule, {{0.199, 0.4, 0}, {}}, 0.01);
  ASSERT_EQ(found.count, 2);
  EXPECT_NEAR(widest(found), 0.6, 1e-5);
  EXPECT_NEAR(found.points[0].separation, -0.001, 1e-5);
  EXPECT_NE(found.points[0].feature, found.points[1].feature);
}

TEST_F(Contact, CrossedCapsulesTouchAtOnePoint) {
  const ConvexShape capsule{Kind::segment, 0.1f, 0, 0.5f, nullptr};
  const Quatd turned{std::sin(0.15), 0, 0, std::cos(0.15)};  // by 17 degrees in the plane in which both lie
  const Touch found = touch(capsule, capsule, {{0.199, 0, 0}, turned}, 0.01);
  ASSERT_EQ(found.count, 1);
  EXPECT_NEAR(found.points[0].separation, -0.001, 1e-6);
  EXPECT_NEAR(found.points[0].on_a.y, 0, 1e-6);
}

TEST(ConvexContact, HoldsForAnySolids) {
  std::mt19937_64 random(5);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  int touching = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Polyhedron box = polyhedron_of_box({0.3f, 0.2f, 0.4f});
    const auto draw = [&] {
      const int kind = static_cast<int>(number(0, 5));
      return ConvexShape{static_cast<Kind>(kind), kind < 2 ? 0.2f : 0.f, 0.25f, 0.35f, &box};
    };
    const ConvexShape a = draw(), b = draw();
    const double x = number(-0.6, 0.6), y = number(-0.6, 0.6), z = number(-0.6, 0.6);
    const double i = number(-1, 1), j = number(-1, 1), k = number(-1, 1);
    const Quatd turned = trial % 4 == 0 ? Quatd{} : normalise(Quatd{i, j, k, number(-1, 1)});
    const Posed pose{{x, y, z}, turned};
    const double margin = 0.01;
    const ConvexDistance nearest = convex_distance(a, b, pose);
    const Touch found = touch(a, b, pose, margin);
    ASSERT_EQ(found.count > 0, nearest.separation <= margin) << trial;
    double deepest = margin;
    for (int p = 0; p < found.count; ++p) {
      const TouchPoint& point = found.points[p];
      ASSERT_LT(length(point.on_b - point.on_a - found.normal * point.separation), 1e-9) << trial;
      ASSERT_GE(point.separation, nearest.separation - 1e-3) << trial;
      ASSERT_LE(point.separation, margin + 1e-9) << trial;
      for (int q = 0; q < p; ++q) ASSERT_NE(point.feature, found.points[q].feature) << trial;
      deepest = std::min(deepest, point.separation);
    }
    if (found.count > 0) {
      ++touching;
      ASSERT_NEAR(deepest, nearest.separation, 0.01) << trial;
    }
  }
  EXPECT_GT(touching, 5000);
}

}  // namespace
}  // namespace pliant
