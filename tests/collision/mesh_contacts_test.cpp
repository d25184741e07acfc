// Tests contact of solids with meshes: known contacts, flat meshes against a plane, random ones against all triangles.
#include "collision/bodies/mesh_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "collision/fields/heightfield.h"
#include "geometry/convex_distance.h"
#include "geometry/triangle.h"
#include "pliant/mesh.h"

namespace pliant {
namespace {

using Kind = ConvexShape::Kind;

constexpr double pi = 3.14159265358979323846;

Quatd turned(const Vec3d& axis, double angle) {
  const Vec3d v = axis * (std::sin(angle / 2) / length(axis));
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

/// A mesh of n x n cells about the origin, with heights.
template <class Height>
TriangleMesh surface(int n, float cell, const Height& height) {
  TriangleMesh mesh;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      const float x = cell * (static_cast<float>(c) - 0.5f * static_cast<float>(n));
      const float z = cell * (static_cast<float>(r) - 0.5f * static_cast<float>(n));
      mesh.positions.push_back({x, height(x, z), z});
    }
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

BodyMesh body_mesh(const TriangleMesh& mesh, BodyMesh::Kind kind = BodyMesh::Kind::surface) {
  return {mesh.positions, mesh.triangles, kind};
}

BodyMesh flat_grid(int n = 60, float cell = 0.3f) {
  return body_mesh(surface(n, cell, [](float, float) { return 0.f; }));
}

/// A valley (slope > 0) or a ridge along z through the origin, of two faces.
BodyMesh folded(float slope) {
  return body_mesh(surface(2, 1, [=](float x, float) { return slope * std::fabs(x); }));
}

/// The surface of a cube of half size 1 about the origin.
BodyMesh closed_cube() {
  TriangleMesh mesh;
  for (const float x : {-1.f, 1.f})
    for (const float y : {-1.f, 1.f})
      for (const float z : {-1.f, 1.f}) mesh.positions.push_back({x, y, z});
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return body_mesh(mesh);
}

std::vector<MeshTouch> touches(const ConvexShape& shape, const Posed& pose, const BodyMesh& mesh, double reach = 0.01) {
  std::vector<MeshTouch> found;
  touch_mesh(shape, pose, mesh, reach, found);
  return found;
}

ConvexShape ball(float radius) { return {Kind::point, radius, 0, 0, nullptr}; }

double deepest(const std::vector<MeshTouch>& found) {
  double least = 1e300;
  for (const MeshTouch& at : found)
    for (int i = 0; i < at.touch.count; ++i) least = std::min(least, at.touch.points[i].separation);
  return least;
}

class Meshes : public testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Quatd any_rotation() { return normalise(Quatd{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}); }

  std::mt19937_64 random_{7};
  Polyhedron box_ = polyhedron_of_box({0.5f, 0.25f, 0.4f});
  ConvexShape cuboid_{Kind::polyhedron, 0, 0, 0, &box_};
};

void expect_flat(const std::vector<MeshTouch>& found, int count, double separation) {
  ASSERT_EQ(found.size(), 1u);
  const Touch& touch = found[0].touch;
  ASSERT_EQ(touch.count, count);
  EXPECT_NEAR(touch.normal.y, 1, 1e-12);
  for (int i = 0; i < count; ++i) {
    EXPECT_NEAR(touch.points[i].separation, separation, 1e-6);
    EXPECT_NEAR(touch.points[i].on_a.y, 0, 1e-6);
  }
}

// Inner edges of a flat mesh must not be felt: at each place of a slide the contact is that with a plane.
TEST_F(Meshes, ABoxOnAFlatGridTouchesWithItsCornersAlone) {
  const BodyMesh grid = flat_grid();
  for (int i = 0; i <= 500; ++i) {
    for (const double depth : {-0.004, 0.001, 0.02}) {
      const Posed pose{{-2.5 + 0.01 * i, 0.25 - depth, 0.3}, turned({0, 1, 0}, i % 3 == 0 ? 0 : 0.011 * i)};
      const auto found = touches(cuboid_, pose, grid);
      expect_flat(found, 4, -depth);
      if (HasFailure()) FAIL() << "at step " << i << ", depth " << depth;
      for (int k = 0; k < 4; ++k) {
        const Vec3d corner = abs(to_local(pose, found[0].touch.points[k].on_b));
        EXPECT_NEAR(length(corner - Vec3d{0.5, 0.25, 0.4}), 0, 1e-5);
      }
    }
  }
}

TEST_F(Meshes, ATiltedBoxOnAFlatGridTouchesWithAnEdgeOrACorner) {
  const BodyMesh grid = flat_grid();
  for (int i = 0; i < 300; ++i) {
    const Quatd rotation = any_rotation();
    const double lowest = [&] {
      double least = 0;
      for (const Vec3f& corner : box_.corners) least = std::min(least, rotate(rotation, convert<double>(corner)).y);
      return least;
    }();
    const Posed pose{{uniform(-3, 3), -lowest - 0.003, uniform(-3, 3)}, rotation};
    const auto found = touches(cuboid_, pose, grid, 1e-4);
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_NEAR(found[0].touch.normal.y, 1, 1e-12);
    EXPECT_NEAR(deepest(found), -0.003, 1e-6);
  }
}

TEST_F(Meshes, ABallOnAFlatGridTouchesAtOnePoint) {
  const BodyMesh grid = flat_grid();
  for (int i = 0; i < 2000; ++i) {
    // Every other one exactly above a corner or an edge of the grid.
    const double x = i % 2 == 0 ? uniform(-5, 5) : static_cast<double>(0.3f * static_cast<float>(i % 20 - 10));
    const Posed pose{{x, 0.5 - 0.002, uniform(-5, 5)}, {}};
    expect_flat(touches(ball(0.5f), pose, grid), 1, -0.002);
    if (HasFailure()) FAIL() << i;
  }
}

TEST_F(Meshes, OtherSolidsOnAFlatGridTouchAsOnAPlane) {
  const BodyMesh grid = flat_grid();
  const Quatd lying = turned({0, 0, 1}, pi / 2);
  const ConvexShape capsule{Kind::segment, 0.2f, 0, 0.5f, nullptr}, cylinder{Kind::cylinder, 0, 0.4f, 0.5f, nullptr},
      cone{Kind::cone, 0, 0.4f, 0.5f, nullptr};
  for (int i = 0; i < 40; ++i) {
    const Quatd about_y = turned({0, 1, 0}, uniform(0, 6));
    const double x = uniform(-3, 3), z = uniform(-3, 3);
    expect_flat(touches(capsule, {{x, 0.199, z}, multiply(about_y, lying)}, grid), 2, -0.001);
    expect_flat(touches(capsule, {{x, 0.699, z}, about_y}, grid), 1, -0.001);
    expect_flat(touches(cylinder, {{x, 0.499, z}, about_y}, grid), 4, -0.001);
    expect_flat(touches(cylinder, {{x, 0.399, z}, multiply(about_y, lying)}, grid), 2, -0.001);
    expect_flat(touches(cone, {{x, 0.499, z}, about_y}, grid), 4, -0.001);
    if (HasFailure()) FAIL() << i;
  }
}

TEST_F(Meshes, ABallLiesInAValleyOnBothFacesAndOnARidgeAtOnePoint) {
  const auto valley = touches(ball(0.3f), {{0, 0.3 * std::sqrt(2.) - 0.001, 0.1}, {}}, folded(1));
  ASSERT_EQ(valley.size(), 2u);
  for (const MeshTouch& at : valley) {
    EXPECT_NEAR(at.touch.normal.y, std::sqrt(0.5), 1e-9);
    ASSERT_EQ(at.touch.count, 1);
    EXPECT_NEAR(at.touch.points[0].separation, -0.001 * std::sqrt(0.5), 1e-6);
  }
  const auto ridge = touches(ball(0.3f), {{0.05, 0.3, 0.1}, {}}, folded(-1));
  ASSERT_EQ(ridge.size(), 1u);
  const double distance = std::sqrt(0.3 * 0.3 + 0.05 * 0.05);
  EXPECT_EQ(ridge[0].touch.count, 1);
  EXPECT_NEAR(ridge[0].touch.points[0].separation, distance - 0.3, 1e-6);
  EXPECT_NEAR(ridge[0].touch.normal.x, 0.05 / distance, 1e-6);
}

TEST_F(Meshes, ABallStandsOnASpike) {
  const BodyMesh spike =
      body_mesh(surface(2, 0.1f, [](float x, float z) { return -3 * std::max(std::fabs(x), std::fabs(z)); }));
  const auto found = touches(ball(0.3f), {{0.01, 0.299, -0.02}, {}}, spike);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].touch.count, 1);
  EXPECT_NEAR(length(found[0].touch.points[0].on_a), 0, 1e-6);
}

TEST_F(Meshes, ABoxBalancesOnARidgeWithTwoPoints) {
  const auto found = touches(cuboid_, {{0, 0.249, 0}, {}}, folded(-1), 0.001);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].touch.normal.y, 1, 1e-6);
  double low = 1, high = -1;
  for (int i = 0; i < found[0].touch.count; ++i) {
    const Vec3d& place = found[0].touch.points[i].on_b;
    EXPECT_NEAR(place.x, 0, 1e-6);
    low = std::min(low, place.z);
    high = std::max(high, place.z);
  }
  EXPECT_NEAR(low, -0.4, 1e-6);
  EXPECT_NEAR(high, 0.4, 1e-6);
}

// Below a valley normals diverge: a corner exactly in it must not slip through between both faces.
TEST_F(Meshes, ACornerInAValleyTouchesBothFaces) {
  const double low = std::sqrt(0.5) * 0.5;
  const Polyhedron box = polyhedron_of_box({0.25f, 0.25f, 0.25f});
  for (const double depth : {0.001, 0.02, 0.1})
    for (const double x : {0., 1e-4, 0.01}) {
      const Posed pose{{x, low - depth, 0.1}, turned({0, 0, 1}, pi / 4)};
      const auto found = touches({Kind::polyhedron, 0, 0, 0, &box}, pose, folded(0.2f));
      EXPECT_EQ(found.size(), x > 0 ? 1u : 2u) << depth << " at " << x;
      EXPECT_LT(deepest(found), -0.9 * (depth - 0.2 * x));
    }
}

TEST_F(Meshes, ABoxInAValleyTouchesBothFaces) {
  const double half = 0.5 * std::sqrt(0.5) + 0.25 * std::sqrt(0.5);  // of its outline, turned by an eighth of a turn
  const auto found =
      touches(cuboid_, {{0.25 * std::sqrt(0.5), half - 0.001, 0.1}, turned({0, 0, 1}, pi / 4)}, folded(1));
  EXPECT_EQ(found.size(), 2u);
  for (const MeshTouch& at : found) EXPECT_NEAR(at.touch.normal.y, std::sqrt(0.5), 1e-6);
}

// A convex mesh of faces at small angles: normals of contact stay between those of its faces.
TEST_F(Meshes, ABoxThatSlidesOverAGentlyCurvedMeshIsNotPushedBack) {
  const auto height = [](float x, float) { return -0.02f * x * x; };
  const BodyMesh hill = body_mesh(surface(60, 0.2f, height));
  for (int i = 0; i <= 400; ++i) {
    const double x = -3 + 0.015 * i, slope = -0.04 * x;
    const Posed pose{{x, -0.02 * x * x + 0.25 - 0.006, 0.07}, turned({0, 0, 1}, std::atan(slope))};
    const auto found = touches(cuboid_, pose, hill, 0.005);
    ASSERT_FALSE(found.empty()) << i;
    for (const MeshTouch& at : found) {
      ASSERT_NEAR(at.touch.normal.x, -slope, 0.03) << i;
      ASSERT_NEAR(at.touch.normal.z, 0, 1e-3) << i;
    }
  }
}

TEST_F(Meshes, SolidsTouchBothSidesOfASurface) {
  const auto found = touches(cuboid_, {{0.1, -0.249, 0.2}, {}}, flat_grid());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].touch.normal.y, -1, 1e-12);
  EXPECT_NEAR(deepest(found), -0.001, 1e-6);
}

TEST_F(Meshes, ThicknessMovesTheSurface) {
  const TriangleMesh flat = surface(10, 0.3f, [](float, float) { return 0.f; });
  const BodyMesh thick(flat.positions, flat.triangles, BodyMesh::Kind::surface, 0.1f);
  const auto found = touches(cuboid_, {{0.1, 0.349, 0.2}, {}}, thick);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(deepest(found), -0.001, 1e-6);
  EXPECT_NEAR(found[0].touch.points[0].on_a.y, 0.1, 1e-6);
}

// A mesh whose triangles have vertices of their own, as files with normals per face have.
TEST_F(Meshes, SeamsOfVerticesAtTheSamePlaceAreNotFelt) {
  const TriangleMesh joined = surface(30, 0.3f, [](float, float) { return 0.f; });
  TriangleMesh apart;
  for (const Triangle& triangle : joined.triangles) {
    const int first = static_cast<int>(apart.positions.size());
    for (const int corner : triangle) apart.positions.push_back(joined.positions[static_cast<std::size_t>(corner)]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  const BodyMesh grid = body_mesh(apart);
  for (int i = 0; i < 100; ++i)
    expect_flat(touches(cuboid_, {{uniform(-2, 2), 0.248, uniform(-2, 2)}, turned({0, 1, 0}, uniform(0, 6))}, grid), 4,
                -0.002);
}

TEST_F(Meshes, TerrainPushesSolidsUpHoweverDeepTheyAre) {
  const auto height = [](float x, float z) { return 0.3f * std::sin(2 * x) * std::cos(1.5f * z); };
  const BodyMesh hills = body_mesh(surface(40, 0.2f, height), BodyMesh::Kind::terrain);
  for (const double depth : {0.001, 0.2, 0.6, 2.})
    for (int i = 0; i < 100; ++i) {
      const double x = uniform(-2.5, 2.5), z = uniform(-2.5, 2.5);
      const double surface_height = static_cast<double>(height(static_cast<float>(x), static_cast<float>(z)));
      for (const ConvexShape& shape : {cuboid_, ball(0.3f)}) {
        const auto found = touches(shape, {{x, surface_height + 0.25 - depth, z}, any_rotation()}, hills);
        ASSERT_FALSE(found.empty()) << depth;
        EXPECT_LT(deepest(found), 0.25 - 0.5 * depth);
        for (const MeshTouch& at : found) EXPECT_GT(at.touch.normal.y, 0.7);
      }
    }
}

// ------------------------------------------------------------------------------------------------ all triangles as oracle

/// The distance of a solid from the nearest of all triangles.
double distance_of_all(const ConvexShape& shape, const Posed& pose, const TriangleMesh& mesh) {
  double least = 1e300;
  for (const Triangle& t : mesh.triangles) {
    Polyhedron triangle;
    for (const int corner : t) triangle.corners.push_back(mesh.positions[static_cast<std::size_t>(corner)]);
    least = std::min(least, convex_distance({Kind::polyhedron, 0, 0, 0, &triangle}, shape, pose).separation);
  }
  return least;
}

TEST_F(Meshes, TheNearestPointIsThatOfAllTriangles) {
  const Polyhedron box = polyhedron_of_box({0.2f, 0.1f, 0.15f});
  const std::vector<ConvexShape> shapes{ball(0.15f),
                                        {Kind::segment, 0.05f, 0, 0.2f, nullptr},
                                        {Kind::polyhedron, 0, 0, 0, &box},
                                        {Kind::cylinder, 0, 0.1f, 0.15f, nullptr},
                                        {Kind::cone, 0.01f, 0.1f, 0.15f, nullptr}};
  int near = 0;
  for (int i = 0; i < 400; ++i) {
    const TriangleMesh mesh = surface(6, 0.25f, [&](float, float) { return static_cast<float>(uniform(-0.15, 0.15)); });
    const BodyMesh bumpy = body_mesh(mesh);
    const ConvexShape& shape = shapes[static_cast<std::size_t>(i) % shapes.size()];
    const Posed pose{{uniform(-0.8, 0.8), uniform(0.1, 0.4), uniform(-0.8, 0.8)}, any_rotation()};
    const double expected = distance_of_all(shape, pose, mesh);
    if (expected < 1e-3) continue;  // overlapping solids have no distance
    const auto found = touches(shape, pose, bumpy, 0.08);
    EXPECT_EQ(found.empty(), expected > 0.08) << i << ": " << expected;
    if (found.empty()) continue;
    ++near;
    EXPECT_NEAR(deepest(found), expected, 2e-3 * 0.2) << i;
  }
  EXPECT_GT(near, 80);
}

// Moving the solid out along each contact by its depth must leave it outside of all triangles, up to the bend of the
// mesh.
TEST_F(Meshes, ABallIsPushedOutByAllItTouches) {
  for (int i = 0; i < 300; ++i) {
    const TriangleMesh mesh = surface(6, 0.25f, [&](float, float) { return static_cast<float>(uniform(-0.1, 0.1)); });
    const BodyMesh bumpy = body_mesh(mesh);
    Vec3d centre{uniform(-0.5, 0.5), 0.3, uniform(-0.5, 0.5)};
    centre.y -= distance_of_all(ball(0.2f), {centre, {}}, mesh) + 0.02;
    for (int sweep = 0; sweep < 50; ++sweep)
      for (const MeshTouch& at : touches(ball(0.2f), {centre, {}}, bumpy))
        for (int k = 0; k < at.touch.count; ++k)
          if (at.touch.points[k].separation < 0) centre -= at.touch.normal * at.touch.points[k].separation;
    EXPECT_GT(distance_of_all(ball(0.2f), {centre, {}}, mesh), -1e-3) << i;
  }
}

// Less deep below the edge than beside it: the way out is over the edge, whichever side of the wall the centre is on.
TEST_F(Meshes, ABoxAtTheEdgeOfAClosedMeshIsLifted) {
  const BodyMesh block = closed_cube();
  for (const double x : {0.501, 1.499})
    for (const double z : {-0.3, 0., 0.4}) {
      const auto found = touches(cuboid_, {{x, 1.25 - 1e-5, z}, {}}, block, 1e-4);
      ASSERT_FALSE(found.empty());
      for (const MeshTouch& at : found) EXPECT_NEAR(at.touch.normal.y, 1, 1e-9) << "at " << x << ' ' << z;
      EXPECT_NEAR(deepest(found), -1e-5, 1e-6);
    }
}

// It lies behind the plane of another side, and sticks out beyond that.
TEST_F(Meshes, WhatLiesBesideAClosedMeshDoesNotOverlapIt) {
  const BodyMesh block = closed_cube();
  const ConvexShape rod{Kind::cylinder, 0, 0.05f, 0.5f, nullptr};
  const auto found = touches(rod, {{1.1, 0, 0.9}, turned({1, 0, 0}, pi / 2)}, block, 0.1);
  ASSERT_FALSE(found.empty());
  for (const MeshTouch& at : found) EXPECT_NEAR(at.touch.normal.x, 1, 1e-6);
  EXPECT_NEAR(deepest(found), 0.05, 1e-4);
}

TEST_F(Meshes, PiecesAreAscendingAndDiffer) {
  const BodyMesh bumpy =
      body_mesh(surface(20, 0.1f, [&](float, float) { return static_cast<float>(uniform(-0.05, 0.05)); }));
  for (int i = 0; i < 200; ++i) {
    const auto found =
        touches(cuboid_, {{uniform(-0.5, 0.5), uniform(0.2, 0.4), uniform(-0.5, 0.5)}, any_rotation()}, bumpy);
    for (std::size_t k = 1; k < found.size(); ++k) EXPECT_LT(found[k - 1].piece, found[k].piece);
  }
}

/// A block of 1 x 0.2 x 4 m whose upper side is at a height of 0, and whose left side is at x = 0. Its sides are two
/// cells high.
TriangleMesh low_block() {
  TriangleMesh mesh;
  for (const float x : {0.f, 1.f})
    for (const float y : {-0.2f, -0.1f, 0.f})
      for (const float z : {-2.f, 0.f, 2.f}) mesh.positions.push_back({x, y, z});
  const auto add = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int y = 0; y < 2; ++y)
    for (int z = 0; z < 2; ++z) {
      const int left = 3 * y + z, right = 9 + left;
      add(left, left + 1, left + 4, left + 3);
      add(right, right + 3, right + 4, right + 1);
    }
  for (int z = 0; z < 2; ++z) {
    add(6 + z, 7 + z, 16 + z, 15 + z);
    add(z, 9 + z, 10 + z, 1 + z);
  }
  for (int y = 0; y < 2; ++y) {
    add(3 * y, 3 * y + 3, 3 * y + 12, 3 * y + 9);
    add(3 * y + 2, 3 * y + 11, 3 * y + 14, 3 * y + 5);
  }
  return mesh;
}

/// The side of the block is smooth as seen from within. A box on the block, pressed in by rounding, is beside it,
/// wherever its centre is.
TEST(MeshContacts, ABoxOnABlockDoesNotOverlapTheSideBelowIt) {
  const TriangleMesh block = low_block();
  const BodyMesh mesh = body_mesh(block);
  const Polyhedron corners = polyhedron_of_box({0.1f, 0.1f, 0.1f});
  const ConvexShape box{Kind::polyhedron, 0, 0, 0, &corners};
  for (const double x : {-0.08, -0.01, 0., 1e-7, 0.01, 0.08})
    for (const double tilt : {0., 1e-4, -1e-4}) {
      std::vector<MeshTouch> found;
      touch_mesh(box, {{x, 0.09997, 0.03}, turned({0, 0, 1}, tilt)}, mesh, 0.05, found, 0.1);
      ASSERT_FALSE(found.empty()) << x << ' ' << tilt;
      for (const MeshTouch& touch : found)
        for (int i = 0; i < touch.touch.count; ++i)
          EXPECT_GT(touch.touch.points[static_cast<std::size_t>(i)].separation, -1e-4) << x << ' ' << tilt;
    }
}

}  // namespace
}  // namespace pliant
