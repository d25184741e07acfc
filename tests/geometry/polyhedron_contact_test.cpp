// Compares the axes of polyhedra with those of a search without short cuts, and contact points with known ones.
#include "geometry/polyhedron_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "math/vector.h"

namespace pliant {
namespace {

class RandomPolyhedra {
 public:
  explicit RandomPolyhedra(int seed) : random_(static_cast<std::uint64_t>(seed)) {}
  float number(float range = 1) { return std::uniform_real_distribution<float>(-range, range)(random_); }
  Vec3f vector(float range = 1) {
    const float x = number(range), y = number(range), z = number(range);
    return {x, y, z};
  }
  Posef pose(float range) {
    const Vec3f place = vector(range), axis = vector();
    return {place, normalise(Quatf{axis.x, axis.y, axis.z, number()})};
  }
  Polyhedron polyhedron() {
    if (number() > 0) {
      const Vec3f half = abs(vector()) + Vec3f{0.2f, 0.2f, 0.2f};
      return moved(polyhedron_of_box(half), pose(0.5f));
    }
    std::vector<Vec3f> points;
    for (int i = 0; i < 12; ++i) points.push_back(vector());
    return moved(polyhedron_of(*convex_hull(points)), pose(0.5f));
  }

 private:
  std::mt19937_64 random_;
};

double gap_along(const Polyhedron& a, const Polyhedron& b, const Vec3d& normal) {
  double highest = -1e30, lowest = 1e30;
  for (const Vec3f& corner : a.corners) highest = std::max(highest, dot(normal, convert<double>(corner)));
  for (const Vec3f& corner : b.corners) lowest = std::min(lowest, dot(normal, convert<double>(corner)));
  return lowest - highest;
}

/// The largest gap along any normal of a face or product of two edges.
double largest_gap(const Polyhedron& a, const Polyhedron& b) {
  double best = -1e30;
  for (const Vec3f& n : a.normals) best = std::max(best, gap_along(a, b, convert<double>(n)));
  for (const Vec3f& n : b.normals) best = std::max(best, gap_along(a, b, -convert<double>(n)));
  for (const PolyhedronEdge& e : a.edges)
    for (const PolyhedronEdge& f : b.edges) {
      const Vec3d across =
          cross(convert<double>(a.corners[e.b] - a.corners[e.a]), convert<double>(b.corners[f.b] - b.corners[f.a]));
      if (length(across) < 1e-6) continue;
      const Vec3d n = across * (1 / length(across));
      best = std::max({best, gap_along(a, b, n), gap_along(a, b, -n)});
    }
  return best;
}

/// Slabs that cross at an edge touch there first, and nearly everywhere else: a contact at the edge alone lets them
/// turn about it into one another.
TEST(PolyhedronContact, SlabsThatCrossAtAnEdgeHaveMorePoints) {
  const Polyhedron below = polyhedron_of_box({1, 0.1f, 1});
  const Quatf askew = normalise(Quatf{-0.02f, 0, -0.012f, 1});
  const Polyhedron above = moved(polyhedron_of_box({1, 0.1f, 0.5f}), Posef{{0.8f, 0.2f, 0.2f}, askew});
  const SeparatingAxis axis = separating_axis(below, above);
  ASSERT_EQ(axis.kind, SeparatingAxis::Kind::edges) << "else this says nothing";
  const Touch found = touch(below, above, 0.1f);
  EXPECT_EQ(found.count, 4);
  double least = 1, most = 0;
  for (int i = 0; i < found.count; ++i) {
    const TouchPoint& point = found.points[static_cast<std::size_t>(i)];
    least = std::min(least, point.separation);
    for (int j = 0; j < i; ++j)
      most = std::max(most, length(point.on_b - found.points[static_cast<std::size_t>(j)].on_b));
    EXPECT_LT(point.separation, 0.1);
  }
  EXPECT_NEAR(least, static_cast<double>(axis.separation), 1e-6) << "the edges are nearest";
  EXPECT_GT(most, 0.5) << "points lie apart";
}

TEST(PolyhedronContact, TheAxisIsTheBestOfAll) {
  RandomPolyhedra random(1);
  int overlapping = 0, by_edges = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Polyhedron a = random.polyhedron(), b = moved(random.polyhedron(), random.pose(1.2f));
    const SeparatingAxis axis = separating_axis(a, b);
    const double best = largest_gap(a, b);
    // Where they are apart, edges that build no face of the difference are no axis; the true distance is no less.
    if (best < 0) {
      EXPECT_NEAR(axis.separation, best, 3e-3) << trial;
    }
    EXPECT_EQ(axis.separation > 3e-3, best > 3e-3) << trial << ' ' << axis.separation << ' ' << best;
    EXPECT_NEAR(gap_along(a, b, convert<double>(axis.normal)), axis.separation, 1e-5) << trial;
    overlapping += best < 0 ? 1 : 0;
    by_edges += axis.kind == SeparatingAxis::Kind::edges ? 1 : 0;
  }
  EXPECT_GT(overlapping, 500);
  EXPECT_GT(by_edges, 100);
}

TEST(PolyhedronContact, PointsLieOnBothAndSeparationIsBetweenThem) {
  RandomPolyhedra random(2);
  int touching = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Polyhedron a = random.polyhedron(), b = moved(random.polyhedron(), random.pose(1.2f));
    const float margin = 0.02f;
    const Touch found = touch(a, b, margin);
    const SeparatingAxis axis = separating_axis(a, b);
    if (axis.separation < 0) {
      EXPECT_GT(found.count, 0) << trial;
    }
    if (axis.separation > margin) {
      EXPECT_EQ(found.count, 0) << trial;
    }
    touching += found.count > 0 ? 1 : 0;
    for (int i = 0; i < found.count; ++i) {
      const TouchPoint& p = found.points[static_cast<std::size_t>(i)];
      const Vec3d error = p.on_b - p.on_a - found.normal * p.separation;
      EXPECT_LT(length(error), 1e-5);
      EXPECT_LE(p.separation, double(margin));
      EXPECT_GE(p.separation, double(axis.separation) - 1e-5);
      const auto is_in = [](const Polyhedron& in, const Vec3d& place) {
        for (int f = 0; f < in.faces(); ++f) {
          const Vec3f on =
              in.corners[static_cast<std::size_t>(in.face_corners[static_cast<std::size_t>(in.first_of_face[f])])];
          if (dot(in.normals[static_cast<std::size_t>(f)], convert<float>(place) - on) > 1e-4f) return false;
        }
        return true;
      };
      EXPECT_TRUE(is_in(a, p.on_a)) << trial << ' ' << i;
      EXPECT_TRUE(is_in(b, p.on_b)) << trial << ' ' << i;
      for (int j = 0; j < i; ++j) EXPECT_NE(p.feature, found.points[static_cast<std::size_t>(j)].feature) << trial;
    }
  }
  EXPECT_GT(touching, 500);
}

/// Slim hulls may meet beside the face that separates them best; what overlaps touches all the same.
TEST(PolyhedronContact, SlimHullsThatOverlapTouch) {
  RandomPolyhedra random(9);
  int overlapping = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const auto slim = [&] {
      std::vector<Vec3f> points;
      for (int i = 0; i < 6; ++i) {
        const Vec3f p = random.vector();
        points.push_back({p.x, 0.15f * p.y, 0.05f * p.z});
      }
      return polyhedron_of(*convex_hull(points));
    };
    const Polyhedron a = slim(), b = moved(slim(), random.pose(0.4f));
    if (separating_axis(a, b).separation >= 0) continue;
    ++overlapping;
    EXPECT_GT(touch(a, b, 0.01f).count, 0) << trial;
  }
  EXPECT_GT(overlapping, 300);
}

TEST(PolyhedronContact, ABoxOnABoxTouchesAtFourCorners) {
  const Polyhedron below = polyhedron_of_box({1, 0.5f, 1});
  const Polyhedron above = moved(polyhedron_of_box({0.5f, 0.25f, 0.4f}), {{0.2f, 0.749f, 0.1f}, {}});
  const Touch found = touch(below, above, 0.01f);
  ASSERT_EQ(found.count, 4);
  EXPECT_EQ(found.normal.y, 1);
  double x = 0, z = 0;
  for (const TouchPoint& p : found.points) {
    EXPECT_NEAR(p.separation, -0.001f, 1e-6f);
    EXPECT_NEAR(p.on_a.y, 0.5f, 1e-6f);
    x += p.on_a.x / 4;
    z += p.on_a.z / 4;
  }
  EXPECT_NEAR(x, 0.2f, 1e-6f);
  EXPECT_NEAR(z, 0.1f, 1e-6f);
}

TEST(PolyhedronContact, ABoxThatOverhangsTouchesAtTheEdgeBelow) {
  const Polyhedron below = polyhedron_of_box({1, 0.5f, 1});
  const Polyhedron above = moved(polyhedron_of_box({0.5f, 0.25f, 0.5f}), {{1.2f, 0.75f, 0}, {}});
  const Touch found = touch(below, above, 0.01f);
  ASSERT_EQ(found.count, 4);
  const auto by_x = [](const TouchPoint& p, const TouchPoint& q) { return p.on_a.x < q.on_a.x; };
  EXPECT_NEAR(std::max_element(found.points.begin(), found.points.end(), by_x)->on_a.x, 1, 1e-6f);
  EXPECT_NEAR(std::min_element(found.points.begin(), found.points.end(), by_x)->on_a.x, 0.7f, 1e-6f);
}

TEST(PolyhedronContact, CrossedBeamsTouchAtOnePoint) {
  const float c = std::sqrt(0.5f);
  const Quatf about_x{std::sqrt((1 - c) / 2), 0, 0, std::sqrt((1 + c) / 2)};  // an eighth of a turn: an edge is on top
  const Quatf about_z{0, 0, std::sqrt((1 - c) / 2), std::sqrt((1 + c) / 2)};
  const Polyhedron below = moved(polyhedron_of_box({2, 0.1f, 0.1f}), {{0, 0, 0}, about_x});
  const float reach = 0.1f * std::sqrt(2.f);
  const Polyhedron above = moved(polyhedron_of_box({0.1f, 0.1f, 2}), {{0.5f, 2 * reach + 0.005f, 0.25f}, about_z});
  const Touch found = touch(below, above, 0.01f);
  ASSERT_EQ(found.count, 1);
  EXPECT_NEAR(found.normal.y, 1, 1e-5f);
  EXPECT_NEAR(found.points[0].separation, 0.005f, 1e-5f);
  EXPECT_NEAR(found.points[0].on_a.x, 0.5f, 1e-5f);
  EXPECT_NEAR(found.points[0].on_a.z, 0, 1e-5f);
  EXPECT_NEAR(found.points[0].on_b.z, 0, 1e-4f);
  EXPECT_TRUE(touch(below, above, 0.001f).count == 0);
}

TEST(PolyhedronContact, FeaturesStayWhileABodySlides) {
  const Polyhedron below = polyhedron_of_box({2, 0.5f, 2}), box = polyhedron_of_box({0.5f, 0.5f, 0.5f});
  const auto features = [&](float x) {
    const Touch found = touch(below, moved(box, {{x, 0.999f, 0.3f}, {}}), 0.01f);
    std::vector<std::uint32_t> out;
    for (int i = 0; i < found.count; ++i) out.push_back(found.points[static_cast<std::size_t>(i)].feature);
    std::sort(out.begin(), out.end());
    return out;
  };
  EXPECT_EQ(features(0).size(), 4U);
  EXPECT_EQ(features(0), features(0.37f));
  EXPECT_NE(features(0), features(1.8f)) << "two corners hang over";
}

}  // namespace
}  // namespace pliant
