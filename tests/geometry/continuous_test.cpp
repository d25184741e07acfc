// Compares continuous tests with samples: if two primitives are within the thickness at a sampled time, an impact must
// be found, and not later; at the time of an impact they must be that near. Then compares them with queries that have
// known answers.
#include "geometry/continuous.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "apps/validate/query_sets.h"
#include "geometry/double_double.h"
#include "geometry/geometry_support.h"
#include "support/paths.h"

namespace pliant {
namespace {

using testing_support::random_point;

struct Motion4 {
  Vec3d from[4], to[4];
};

/// Random corners with the difficulty that `kind` selects.
Motion4 random_motion(std::mt19937_64& random, int kind) {
  Motion4 m;
  const Vec3d far = kind % 7 == 6 ? Vec3d{1000, -2000, 500} : Vec3d{};
  for (int i = 0; i < 4; ++i) {
    m.from[i] = far + random_point(random, 1);
    m.to[i] = m.from[i] + random_point(random, kind % 2 == 0 ? 0.5 : 3);
  }
  switch (kind % 7) {
    case 1:  // flat
      for (int i = 0; i < 4; ++i) m.from[i].y = m.to[i].y = 0;
      break;
    case 2:  // a sliver, or an edge without length
      m.from[3] = m.from[2] + (m.from[1] - m.from[2]) * 1e-9;
      m.to[3] = m.to[2] + (m.to[1] - m.to[2]) * 1e-9;
      break;
    case 3:  // parallel edges
      m.from[3] = m.from[2] + (m.from[1] - m.from[0]);
      m.to[3] = m.to[2] + (m.to[1] - m.to[0]);
      break;
    case 4:  // no corner moves
      for (int i = 0; i < 4; ++i) m.to[i] = m.from[i];
      break;
    case 5:  // they start with a point in common
      m.from[0] = m.from[2];
      break;
    default:
      break;
  }
  return m;
}

template <bool edges>
double distance_at(const Motion4& m, double t) {
  Vec3d x[4];
  for (int i = 0; i < 4; ++i) x[i] = m.from[i] + (m.to[i] - m.from[i]) * t;
  if constexpr (edges) return std::sqrt(closest_on_segments<double>({x[0], x[1]}, {x[2], x[3]}).distance_squared);
  return std::sqrt(closest_on_triangle(x[0], x[1], x[2], x[3]).distance_squared);
}

template <bool edges, class R>
Impact<R> impact_of(const Motion4& m, R thickness) {
  Vec3<R> from[4], to[4];
  for (int i = 0; i < 4; ++i) {
    from[i] = convert<R>(m.from[i]);
    to[i] = convert<R>(m.to[i]);
  }
  if constexpr (edges) return edge_edge_impact(from, to, thickness);
  return vertex_triangle_impact(from, to, thickness);
}

/// Runs the test in the arithmetic of R only; for double the public function does more.
template <bool edges, class R>
bool undecided_hit(const Motion4& m, R thickness) {
  Vec3<R> from[4], to[4];
  for (int i = 0; i < 4; ++i) {
    from[i] = convert<R>(m.from[i]);
    to[i] = convert<R>(m.to[i]);
  }
  if constexpr (edges) return edge_edge_impact<R>(from, to, thickness).hit;
  return vertex_triangle_impact<R>(from, to, thickness).hit;
}

template <bool edges, class R>
void check_against_samples(double tolerance) {
  std::mt19937_64 random(edges ? 21 : 22);
  int hits = 0, misses = 0;
  for (int i = 0; i < 4000; ++i) {
    Motion4 m = random_motion(random, i);
    for (int k = 0; k < 4; ++k) {  // exact in float, so that both precisions see the same motion
      m.from[k] = convert<double>(convert<float>(m.from[k]));
      m.to[k] = convert<double>(convert<float>(m.to[k]));
    }
    const double thickness = static_cast<double>(static_cast<float>(i % 3 == 0 ? 0 : i % 3 == 1 ? 0.01 : 0.3));
    const Impact<R> impact = impact_of<edges>(m, static_cast<R>(thickness));
    (impact.hit ? hits : misses) += 1;
    const double time = static_cast<double>(impact.time);
    for (int k = 0; k <= 200; ++k) {
      const double t = k / 200.0;
      if (distance_at<edges>(m, t) > thickness) continue;
      ASSERT_TRUE(impact.hit) << i;
      ASSERT_LE(time, t + tolerance) << i;
      break;
    }
    if (impact.hit) {
      ASSERT_LE(distance_at<edges>(m, time), thickness + tolerance) << i;
    }
  }
  EXPECT_GT(hits, 800);
  EXPECT_GT(misses, 800);
}

TEST(VertexTriangleImpact, IsNeitherMissedNorInvented) {
  check_against_samples<false, double>(1e-9);
  check_against_samples<false, float>(2e-4);
}

TEST(EdgeEdgeImpact, IsNeitherMissedNorInvented) {
  check_against_samples<true, double>(1e-9);
  check_against_samples<true, float>(2e-4);
}

/// Every corner moves linearly to where a rotation about (1, 1, 1) by 30 degrees takes it. At each time this is one
/// invertible linear map of all points, so what is apart stays apart, though no fixed plane separates it for long.
Motion4 turned_together(const Vec3d (&from)[4]) {
  constexpr double a = 0.9106836025229591, b = 0.3333333333333333,
                   c = -0.2440169358562925;  // rows of the rotation: (a c b), (b a c), (c b a)
  Motion4 m;
  for (int i = 0; i < 4; ++i) {
    const Vec3d& p = from[i];
    m.from[i] = p;
    m.to[i] = {a * p.x + c * p.y + b * p.z, b * p.x + a * p.y + c * p.z, c * p.x + b * p.y + a * p.z};
  }
  return m;
}

TEST(EdgeEdgeImpact, FollowsEdgesThatTurnCloseToOneAnother) {
  for (const double gap : {1e-2, 1e-4, 1e-5}) {
    const Motion4 edges = turned_together({{-1, gap, 0.2}, {1, gap, 0.3}, {0, 0, -1}, {0.1, 0, 1}});
    EXPECT_FALSE(impact_of<true>(edges, 0.0).hit) << gap;
    EXPECT_TRUE(impact_of<true>(edges, 2 * gap).hit) << gap;
    const Motion4 triangle = turned_together({{0.2, gap, 0.2}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    EXPECT_FALSE(impact_of<false>(triangle, 0.0).hit) << gap;
    EXPECT_TRUE(impact_of<false>(triangle, 2 * gap).hit) << gap;
  }
}

TEST(VertexTriangleImpact, KnowsTimeSideAndNormal) {
  for (const float side : {1.f, -1.f}) {
    const Vec3f from[4] = {{0.25f, 3 * side, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const Vec3f to[4] = {{0.25f, -1 * side, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const auto impact = vertex_triangle_impact(from, to, 0.f), thick = vertex_triangle_impact(from, to, 1.f);
    ASSERT_TRUE(impact.hit && thick.hit);
    EXPECT_NEAR(impact.time, 0.75f, 1e-5f);
    EXPECT_NEAR(thick.time, 0.5f, 1e-5f);
    EXPECT_NEAR(impact.normal.y, side, 1e-6f);
    EXPECT_EQ(impact.front, side > 0);
    EXPECT_EQ(thick.front, side > 0);
    EXPECT_NEAR(thick.gap, 1, 1e-4f);
  }
}

TEST(VertexTriangleImpact, SeesTheFastestAndTheTouching) {
  const Vec3f from[4] = {{0.25f, 1e6f, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  const Vec3f to[4] = {{0.25f, -1e6f, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  EXPECT_TRUE(vertex_triangle_impact(from, to, 0.f).hit);
  const Vec3f ends_on_it[4] = {{0.25f, 0, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  EXPECT_TRUE(vertex_triangle_impact(from, ends_on_it, 0.f).hit);
  const auto begins_on_it = vertex_triangle_impact(ends_on_it, from, 0.f);
  EXPECT_TRUE(begins_on_it.hit);
  EXPECT_EQ(begins_on_it.time, 0);
  const Vec3f beside[4] = {{0.25f, 1e-3f, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  const Vec3f along[4] = {{9, 1e-3f, 0.25f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  EXPECT_FALSE(vertex_triangle_impact(beside, along, 0.f).hit);
}

/// Cases that double precision cannot decide: at `time` the primitives are as described here, in the plane z = 0.
enum class Near {
  border,        ///< they cross `beside` of a border
  along_border,  ///< the same, and they move along it all the time
  end,           ///< they end at the distance `beside` from each other
  sliding,       ///< they slide over each other at the thickness and `beside`
  kinds
};

/// Makes such a case. Rotation and rounding to double displace the primitives a little.
template <bool edges>
Motion4 near_motion(std::mt19937_64& random, Near kind, double beside, double thickness) {
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const double x = uniform(random), angle = 6 * uniform(random), middle = uniform(random);
  const double c = std::cos(angle), s = std::sin(angle), time = kind == Near::end ? 1 : middle;
  const bool at_border = kind == Near::border || kind == Near::along_border;
  const double y = at_border ? 0 : 0.2, gap = at_border ? beside : 0;
  const double height = kind == Near::end ? beside : kind == Near::sliding ? thickness + beside : 0;
  const Vec3d common = random_point(random, 1), away = random_point(random, 1);
  Vec3d apart = random_point(random, 1);
  if (kind == Near::along_border) apart.y = 0;
  if (kind == Near::end) apart.z = -std::abs(apart.z);
  if (kind == Near::sliding) apart.z = 0;
  Vec3d at[4];
  if (edges) {
    at[0] = {-1, y, height}, at[1] = {1, y, height};
    at[2] = {x, gap, 0}, at[3] = {x, 1, 0};
  } else {
    at[0] = {x, y - gap, height};
    at[1] = {0, 0, 0}, at[2] = {1, 0, 0}, at[3] = {0.5, 1, 0};
  }
  const auto turned = [&](const Vec3d& p) {
    const double q = s * p.x + c * p.y;
    return Vec3d{c * p.x - s * p.y, 0.6 * q - 0.8 * p.z, 0.8 * q + 0.6 * p.z};
  };
  Motion4 m;
  for (int i = 0; i < 4; ++i) {
    const Vec3d speed = common + (i < (edges ? 2 : 1) ? turned(apart) : Vec3d{});
    m.from[i] = away + turned(at[i]) - speed * time;
    m.to[i] = away + turned(at[i]) + speed * (1 - time);
  }
  return m;
}

/// What is proved in double precision must agree with a computation entirely in double-double precision.
template <bool edges>
void check_decisions() {
  std::mt19937_64 random(edges ? 31 : 32);
  int hits = 0, misses = 0, open = 0;
  for (int i = 0; i < 6000; ++i) {
    const double scale = std::pow(10.0, -18 + i / 4 % 5), beside = (i / 20 % 5 - 2) * scale;
    const double thickness = i / 4 % 2 == 0 ? 0 : 1e-3;
    const Motion4 m =
        near_motion<edges>(random, static_cast<Near>(i % static_cast<int>(Near::kinds)), beside, thickness);
    const bool found = impact_of<edges>(m, thickness).hit;
    ASSERT_EQ(found, undecided_hit<edges>(m, DoubleDouble(thickness))) << i;
    (found ? hits : misses) += 1;
    open += !found && undecided_hit<edges>(m, thickness);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
  EXPECT_GT(open, 1000);
}

TEST(VertexTriangleImpact, DecidesAsTwiceThePrecisionDoes) { check_decisions<false>(); }
TEST(EdgeEdgeImpact, DecidesAsTwiceThePrecisionDoes) { check_decisions<true>(); }

// All coordinates are exact in double, so the answers are known: at half time the oblique motion is at height 0 and y =
// 0, where the other primitive begins, or very slightly beside it.
TEST(EdgeEdgeImpact, TellsWhatTouchesFromWhatPassesByAHair) {
  for (const double hair : {1e-17, 1e-20, 1e-25}) {
    for (const double end : {hair, 0.0, -hair}) {
      const Motion4 edges{{{-1, 1, 1}, {1, 1, 1}, {0.25, end, 0}, {0.25, 1, 0}},
                          {{-1, -1, -1}, {1, -1, -1}, {0.25, end, 0}, {0.25, 1, 0}}};
      EXPECT_EQ(impact_of<true>(edges, 0.0).hit, end <= 0) << end;
      EXPECT_TRUE(undecided_hit<true>(edges, 0.0)) << end;
      const Motion4 triangle{{{0.25, 1, 1}, {0, end, 0}, {1, end, 0}, {0.5, 1, 0}},
                             {{0.25, -1, -1}, {0, end, 0}, {1, end, 0}, {0.5, 1, 0}}};
      EXPECT_EQ(impact_of<false>(triangle, 0.0).hit, end <= 0) << end;
      EXPECT_TRUE(undecided_hit<false>(triangle, 0.0)) << end;
    }
  }
}

// A border rotates while a near primitive moves along it: inside long before and long after, and at half time, when
// they cross, at the border or very slightly beside it.
TEST(EdgeEdgeImpact, LooksBetweenTheTimesAtWhichItIsSure) {
  for (const double end : {1e-17, 0.0, -1e-17}) {
    const Motion4 edges{{{-1, -0.5, 0.5}, {1, 0.5, 0.5}, {0.25, end, 0}, {0.25, 1, 0}},
                        {{-1, 0.5, -0.5}, {1, -0.5, -0.5}, {-0.25, end, 0}, {-0.25, 1, 0}}};
    EXPECT_EQ(impact_of<true>(edges, 0.0).hit, end <= 0) << end;
    EXPECT_TRUE(undecided_hit<true>(edges, 0.0)) << end;
    const Motion4 triangle{{{0.25, end, 0}, {-1, -0.5, 0.5}, {1, 0.5, 0.5}, {0, -1, 0.5}},
                           {{-0.25, end, 0}, {-1, 0.5, -0.5}, {1, -0.5, -0.5}, {0, -1, -0.5}}};
    EXPECT_EQ(impact_of<false>(triangle, 0.0).hit, end <= 0) << end;
    EXPECT_TRUE(undecided_hit<false>(triangle, 0.0)) << end;
  }
}

struct Counts {
  int queries = 0, missed = 0, invented = 0;
  int missed_in_double = 0,
      far_in_double = 0;  ///< false impacts of double precision, in which the primitives are not within 1e-12
};

template <bool edges>
void check_queries(const char* kind) {
  const std::string root = test::in_shared_data("ccd/sample-queries");
  if (!std::filesystem::exists(root)) GTEST_SKIP() << "no query sets beside this tree";
  Counts sum;
  for (const validate::CollisionQuery& query : validate::read_query_sets(root, kind)) {
    Motion4 m;
    std::copy(std::begin(query.from), std::end(query.from), m.from);
    std::copy(std::begin(query.to), std::end(query.to), m.to);
    const bool found = impact_of<edges>(m, 0.0).hit, found_in_double = undecided_hit<edges>(m, 0.0);
    ++sum.queries;
    sum.missed += query.hits && !found;
    sum.invented += found && !query.hits;
    sum.missed_in_double += query.hits && !found_in_double;
    sum.far_in_double += found_in_double && !query.hits && !impact_of<edges>(m, 1e-12).hit;
  }
  EXPECT_GE(sum.queries, 900);
  EXPECT_EQ(sum.missed, 0);
  EXPECT_LE(sum.invented * 100, sum.queries);
  EXPECT_EQ(sum.missed_in_double, 0);
  EXPECT_EQ(sum.far_in_double, 0);
  testing::Test::RecordProperty("queries", sum.queries);
  testing::Test::RecordProperty("invented", sum.invented);
}

TEST(VertexTriangleImpact, AnswersTheQuerySets) { check_queries<false>("vertex-face"); }
TEST(EdgeEdgeImpact, AnswersTheQuerySets) { check_queries<true>("edge-edge"); }

}  // namespace
}  // namespace pliant
