// Tests the filter of a single pair: random, degenerate and nearly touching pairs keep their distance at the end and on
// the whole way.
#include "collision/filter/plane_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "collision/random_support.h"
#include "geometry/exact.h"
#include "geometry/triangle.h"
#include "math/vector.h"

namespace pliant {
namespace {

using namespace testing_support;

struct Case {
  PairStencil pair{{0, 1, 2, 3}, 1};
  Record positions[4], displacements[4];
  double size = 1, least = 0;
};

Record record(const Vec3d& v, float w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
}

/// Makes a primitive degenerate: without extent, on a line, or with two corners in one place.
void degenerate(Random& random, Vec3d (&x)[4]) {
  switch (random() % 4) {
    case 0:
      x[3] = x[2];
      break;
    case 1:
      x[3] = x[2] * 2. - x[1];
      break;
    case 2:
      x[1] = x[2] = x[3];
      break;
    default:
      x[1] = x[0] + (x[3] - x[2]);
      break;  // parallel edges
  }
}

/// Moves the first side so that it is `gap` away from the second.
void bring_near(const PairStencil& pair, Vec3d (&x)[4], double gap) {
  Record at[4];
  for (int i = 0; i < 4; ++i) at[i] = record(x[i]);
  const PairDistance now = pair_distance(pair, at);
  for (int i = 0; i < pair.first_side; ++i) x[i] = x[i] - now.normal * (now.distance - gap);
}

/// Two sides that move towards each other, each corner with a motion of its own.
Case random_case(Random& random) {
  Case c;
  c.pair.first_side = random() % 2 == 0 ? 1 : 2;
  c.size = std::pow(10., uniform(random, -3, 1));
  Vec3d x[4];
  for (Vec3d& p : x) p = random_place(random, c.size);
  if (random() % 3 == 0) degenerate(random, x);
  if (random() % 2 == 0) bring_near(c.pair, x, c.size * std::pow(10., uniform(random, -4, -1)));
  const double away = random() % 3 == 0 ? 1000 * c.size : 0;
  const double speed = c.size * std::pow(10., uniform(random, -4, 2));
  const Vec3d toward = (x[3] + x[2]) * 0.5 - x[0];
  const double scale = speed / std::max(length(toward), 1e-12);
  for (int i = 0; i < 4; ++i) {
    const double sign = i < c.pair.first_side ? 1 : -0.3;
    c.positions[i] = record(x[i] + Vec3d{away, -away, away}, random() % 6 == 0 ? 0.f : 1.f);
    c.displacements[i] = record(toward * (sign * scale * uniform(random, 0, 1)) + random_place(random, 0.3 * speed));
    if (c.positions[i].w == 0 && random() % 2 == 0) c.displacements[i] = {};
  }
  c.least = c.size * std::pow(10., uniform(random, -5, -1));
  return c;
}

Record end_of(const Record& x, const Record& d) { return {x.x + d.x, x.y + d.y, x.z + d.z, x.w}; }

/// Applies the filter to one pair.
Separation filter(Case& c, std::array<float, 4>& shares) {
  SeparatingSlab slab;
  shares = {1, 1, 1, 1};
  const PairDistance at = pair_distance(c.pair, c.positions);
  const Separation found = plan_separation(c.pair, at, c.positions, c.displacements, {}, c.least, slab, shares);
  for (int i = 0; i < 4; ++i)
    if (found == Separation::planned && ends_beyond(slab, i, c.positions, c.displacements, shares[i])) shares[i] = 0;
  for (int i = 0; i < 4; ++i) {
    Record& d = c.displacements[i];
    d = {d.x * shares[i], d.y * shares[i], d.z * shares[i], 0};
  }
  return found;
}

/// The distance in double at time t of the motion.
double distance_at(const Case& c, double t) {
  Vec3d x[4];
  for (int i = 0; i < 4; ++i) {
    const Record end = end_of(c.positions[i], c.displacements[i]);
    const Vec3d from{double(c.positions[i].x), double(c.positions[i].y), double(c.positions[i].z)};
    const Vec3d to{double(end.x), double(end.y), double(end.z)};
    const Vec3d origin{double(c.positions[0].x), double(c.positions[0].y), double(c.positions[0].z)};
    x[i] = (from - origin) + (to - from) * t;
  }
  if (c.pair.first_side == 1) return std::sqrt(closest_on_triangle(x[0], x[1], x[2], x[3]).distance_squared);
  return std::sqrt(closest_on_segments({x[0], x[1]}, {x[2], x[3]}).distance_squared);
}

/// The least distance along the motion, by steps so small that no smaller distance can be missed; -1 if they would be
/// too many.
double least_on_the_way(const Case& c) {
  double first = 0, second = 0;
  for (int i = 0; i < 4; ++i) {
    const Record end = end_of(c.positions[i], c.displacements[i]);
    const Vec3d move{double(end.x) - c.positions[i].x, double(end.y) - c.positions[i].y,
                     double(end.z) - c.positions[i].z};
    double& most = i < c.pair.first_side ? first : second;
    most = std::max(most, length(move));
  }
  double t = 0, least = 1e300;
  for (int steps = 0; steps < 20000; ++steps) {
    const double distance = distance_at(c, t);
    least = std::min(least, distance);
    if (t >= 1) return least;
    t = std::min(1., t + std::max(0.9 * distance, 1e-9 * c.size) / std::max(first + second, 1e-30));
  }
  return least < 1e-7 * c.size ? least : -1;
}

/// The distance that the filter guarantees. Distances are accurate to rounding, but the plane's normal only to its
/// square root (geometry/triangle.h).
double promised(const Case& c, double distance) {
  return std::min(c.least, 0.98 * distance) * (1 - 1e-6) - 1e-7 * c.size;
}

TEST(PlaneFilter, KeepsPairsApartAtTheEndAndOnTheWay) {
  Random random(81);
  int planned = 0, free = 0, walked = 0, crossed_without = 0;
  for (int i = 0; i < 60000; ++i) {
    Case c = random_case(random);
    const Case before = c;
    const double distance = pair_distance(c.pair, c.positions).distance;
    std::array<float, 4> shares{};
    const Separation found = filter(c, shares);
    if (found == Separation::unresolvable || distance < 1e-5 * c.size) continue;
    (found == Separation::free ? free : planned) += 1;
    ASSERT_GE(distance_at(c, 1), promised(c, distance)) << i;
    ASSERT_GE(pair_distance(c.pair, c.positions).distance, 0.);
    if (i % 8 != 0) continue;
    const double least = least_on_the_way(c), without = least_on_the_way(before);
    if (least >= 0) ++walked;
    ASSERT_TRUE(least == -1 || least >= promised(c, distance)) << i;
    if (without >= 0 && without < 1e-6 * c.size) ++crossed_without;
  }
  EXPECT_GT(planned, 10000);
  EXPECT_GT(free, 10000);
  EXPECT_GT(walked, 3000);
  EXPECT_GT(crossed_without, 50) << "most cases would pass without a filter";
}

TEST(PlaneFilter, LeavesNoExactCrossingOfATriangleThatStandsStill) {
  Random random(82);
  int would_cross = 0;
  for (int i = 0; i < 60000; ++i) {
    Case c = random_case(random);
    c.pair.first_side = 1;
    for (int k = 1; k < 4; ++k) c.displacements[k] = {}, c.positions[k].w = random() % 2 == 0 ? 0.f : 1.f;
    c.positions[0].w = 1;
    const auto place = [&](int k) { return Vec3f{c.positions[k].x, c.positions[k].y, c.positions[k].z}; };
    const auto way = [&] {
      const Record end = end_of(c.positions[0], c.displacements[0]);
      return how_edge_meets_triangle({place(0), {end.x, end.y, end.z}}, {place(1), place(2), place(3)});
    };
    const bool crosses = way() != EdgeTriangle::apart;
    std::array<float, 4> shares{};
    if (filter(c, shares) == Separation::unresolvable) {
      ASSERT_LT(pair_distance(c.pair, c.positions).distance, 1e-6 * c.size) << i;
      continue;
    }
    would_cross += crosses ? 1 : 0;
    ASSERT_EQ(way(), EdgeTriangle::apart) << i;
  }
  EXPECT_GT(would_cross, 1000);
}

/// 2 mm above a level mesh, 20 mm before its triangle or edge, and 4.5 mm past that border in one step.
TEST(PlaneFilter, LeavesWhatSlidesOverALevelMesh) {
  for (const int first_side : {1, 2}) {
    Case c;
    c.pair.first_side = first_side;
    c.least = 2e-4;
    c.positions[0] = record({-0.02, 0.002, 0}, 1);
    c.positions[1] = first_side == 2 ? record({-0.05, 0.002, 0.01}, 1) : record({0.2, 0, 0});
    c.positions[2] = record({0, 0, -0.1});
    c.positions[3] = record({0, 0, 0.1});
    for (int i = 0; i < first_side; ++i) c.displacements[i] = record({0.0245, 0, 0});
    std::array<float, 4> shares{};
    EXPECT_EQ(filter(c, shares), Separation::free) << first_side;
    for (const float share : shares) EXPECT_EQ(share, 1);
  }
}

TEST(PlaneFilter, LeavesWhatCannotBeShortened) {
  Random random(83);
  int moved_and_kept = 0, unresolvable = 0;
  for (int i = 0; i < 30000; ++i) {
    Case c = random_case(random);
    for (int k = 0; k < c.pair.first_side; ++k) c.positions[k].w = 0;
    for (int k = c.pair.first_side; k < 4; ++k) c.positions[k].w = 1;
    const Case before = c;
    const double distance = pair_distance(c.pair, c.positions).distance;
    std::array<float, 4> shares{};
    const Separation found = filter(c, shares);
    for (int k = 0; k < 4; ++k) {
      if (k < c.pair.first_side) {
        ASSERT_EQ(shares[k], 1) << "what nothing pushes has its way";
        ASSERT_EQ(c.displacements[k].x, before.displacements[k].x);
      }
      ASSERT_GE(shares[k], 0);
      ASSERT_LE(shares[k], 1);
      if (shares[k] == 0) {
        const Record end = end_of(c.positions[k], c.displacements[k]);
        ASSERT_TRUE(end.x == c.positions[k].x && end.y == c.positions[k].y && end.z == c.positions[k].z) << i;
      }
    }
    if (found == Separation::unresolvable) {
      ++unresolvable;
    } else if (distance > 1e-5 * c.size) {
      moved_and_kept += found == Separation::planned ? 1 : 0;
      ASSERT_GE(distance_at(c, 1), promised(c, distance)) << i;
    }
  }
  EXPECT_GT(moved_and_kept, 500);
  EXPECT_GT(unresolvable, 500) << "what is overrun is said to be";
}

TEST(PlaneFilter, ShortensNoMoreThanItMust) {
  // A vertex 1 above a large triangle falls by 2. It must stop at the upper bound of the separating margin.
  Case c;
  c.positions[0] = {0, 1, 0, 1};
  c.positions[1] = {-9, 0, -9, 0};
  c.positions[2] = {9, 0, -9, 0};
  c.positions[3] = {0, 0, 9, 0};
  for (Record& d : c.displacements) d = {};
  c.displacements[0] = {0.5f, -2, 0, 0};
  c.least = 0.01;
  std::array<float, 4> shares{};
  EXPECT_EQ(filter(c, shares), Separation::planned);
  const float height = 1 + c.displacements[0].y;
  EXPECT_GT(height, 0.01f);
  EXPECT_LT(height, 0.12f) << "the plane leaves a tenth of the gap to a side that does not move";
}

/// A vertex and a triangle 0.001 from it, of 0.01.
Case near_triangle(const Vec3d& vertex, const Vec3d& at) {
  Case c;
  const Vec3d corners[4] = {vertex, {-0.005, 0, -0.005}, {0.005, 0, -0.005}, {0, 0, 0.005}};
  for (int i = 0; i < 4; ++i) {
    c.positions[i] = record(at + corners[i], 1);
    c.displacements[i] = {};
  }
  c.least = 1e-5;
  return c;
}

TEST(PlaneFilter, LeavesWhatMovesTogether) {
  Case c = near_triangle({0, 0.001, 0}, {});
  for (Record& d : c.displacements) d = {0.001f, -0.003f, 0.002f, 0};  // three times the gap
  c.displacements[0].y -= 5e-4f;
  std::array<float, 4> shares{};
  EXPECT_EQ(filter(c, shares), Separation::free);
}

TEST(PlaneFilter, LeavesWhatSlidesPastAnEdge) {
  Case c = near_triangle({0, 0.0003, -0.0055}, {});
  c.displacements[0] = {0, -0.002f, 0, 0};
  std::array<float, 4> shares{};
  EXPECT_EQ(filter(c, shares), Separation::free) << "it passes 0.5 mm beside the edge";
}

/// The margin allows for rounding. Of steps that were truncated without that, half ended a rounding beyond their plane,
/// so that their vertices did not move at all.
TEST(PlaneFilter, DoesNotStopWhatRoundingPutsBeyondThePlane) {
  Random random(84);
  for (int i = 0; i < 2000; ++i) {
    Case c = near_triangle({0, 0.001, 0}, random_place(random, 1));
    for (int k = 1; k < 4; ++k) c.positions[k].w = 0;
    c.displacements[0] = record(Vec3d{0, -0.002, 0} + random_place(random, 5e-4));
    const double way = double(c.displacements[0].y);
    std::array<float, 4> shares{};
    ASSERT_EQ(filter(c, shares), Separation::planned) << i;
    ASSERT_LT(double(c.displacements[0].y), 0.3 * way) << i;
  }
}

}  // namespace
}  // namespace pliant
