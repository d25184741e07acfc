// Tests the division of closed meshes into convex pieces: shapes of boxes exactly, rings and bowls within the
// tolerance.
#include "pliant/decompose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using std::numbers::pi;

/// A prism: a polygon in the xy-plane, counter-clockwise, from z = 0 to `depth`; `fan` has its triangles.
TriangleMesh prism(const std::vector<std::array<float, 2>>& polygon, const std::vector<std::array<int, 3>>& fan,
                   float depth) {
  TriangleMesh mesh;
  const int n = static_cast<int>(polygon.size());
  for (const float z : {0.f, depth})
    for (const auto& [x, y] : polygon) mesh.positions.push_back({x, y, z});
  for (const auto& [a, b, c] : fan) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({n + a, n + b, n + c});
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  return mesh;
}

TriangleMesh l_shape() {
  return prism({{{0, 0}}, {{3, 0}}, {{3, 1}}, {{1, 1}}, {{1, 2}}, {{0, 2}}},
               {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 3, 5}}, {{3, 4, 5}}}, 1);
}

/// A torus about the y-axis.
TriangleMesh torus(float ring, float tube, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * pi * i / around, v = 2 * pi * j / across;
      const double r = double(ring) + double(tube) * std::cos(v);
      mesh.positions.push_back({float(r * std::cos(u)), float(double(tube) * std::sin(v)), float(r * std::sin(u))});
    }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

const std::vector<Vec3f>& points_of(const Solid& solid) { return std::get<Hull>(solid.shape).points; }

/// The depth of a point in the deepest of the pieces; negative if it is outside of all [m].
double depth_in(const Decomposition& pieces, const Vec3f& p) {
  double deepest = -1e30;
  for (const Solid& solid : pieces.solids) {
    const auto hull = convex_hull(points_of(solid));
    double depth = 1e30;
    for (std::size_t f = 0; f < hull->faces.size(); ++f)
      depth = std::min(depth, -double(dot(hull->normals[f], p - hull->corners[std::size_t(hull->faces[f][0])])));
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

double mass_of(const Decomposition& pieces) {
  double mass = 0;
  for (const Solid& solid : pieces.solids) {
    const auto hull = convex_hull(points_of(solid));
    std::vector<Vec3d> corners;
    for (const Vec3f& corner : hull->corners) corners.push_back(convert<double>(corner));
    mass += moments_of_mesh(corners, hull->triangles()).mass * double(solid.density);
  }
  return mass;
}

TEST(Decompose, LeavesAConvexMeshWhole) {
  const Decomposition ball = decompose(sphere_mesh(2));
  ASSERT_EQ(ball.solids.size(), 1U);
  EXPECT_LE(points_of(ball.solids[0]).size(), 64U);
  EXPECT_EQ(ball.filled, 0);
}

TEST(Decompose, DividesAnLIntoTwoBoxes) {
  const Decomposition l = decompose(l_shape());
  ASSERT_EQ(l.solids.size(), 2U);
  EXPECT_FLOAT_EQ(l.solids[0].density, 1000) << "which is scaled where volumes differ";
  EXPECT_NEAR(mass_of(l), 4000, 1e-3);
  EXPECT_GT(depth_in(l, {2.9f, 0.9f, 0.5f}), 0);
  EXPECT_GT(depth_in(l, {0.1f, 1.9f, 0.5f}), 0);
  EXPECT_LT(depth_in(l, {1.05f, 1.05f, 0.5f}), -0.04);
  EXPECT_EQ(l.filled, 0);
}

/// Mass, centre and inertia are the mesh's: of the L, those of two boxes.
TEST(Decompose, HasTheInertiaOfTheMesh) {
  DecomposeOptions options;
  options.density = 2;
  const BodyInertia found = decompose(l_shape(), options).inertia;
  const Object boxes = make_body(
      {{Box{{1.5f, 0.5f, 0.5f}}, {1.5f, 0.5f, 0.5f}, {}, 2}, {Box{{0.5f, 0.5f, 0.5f}}, {0.5f, 1.5f, 0.5f}, {}, 2}});
  BodyOptions known;
  known.inertia = found;
  const Object body = make_body({}, known);
  EXPECT_NEAR(body.masses[0], 8, 1e-5);
  EXPECT_NEAR(length(body.positions[0] - boxes.positions[0]), 0, 1e-6);
  std::array<float, 3> own{body.frames[0].inertia.x, body.frames[0].inertia.y, body.frames[0].inertia.z},
      expected{boxes.frames[0].inertia.x, boxes.frames[0].inertia.y, boxes.frames[0].inertia.z};
  std::sort(own.begin(), own.end());
  std::sort(expected.begin(), expected.end());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(own[i], expected[i], 1e-4 * double(expected[i]));
}

/// A hole stays open, up to the tolerance and a cell of the grid, and nothing of the ring is lost but what 64 corners
/// cut off.
TEST(Decompose, KeepsTheHoleOfARing) {
  DecomposeOptions options;
  options.tolerance = 0.04f;
  const TriangleMesh mesh = torus(1, 0.25f, 48, 16);
  const Decomposition ring = decompose(mesh, options);
  EXPECT_LE(ring.solids.size(), 32U);
  EXPECT_LE(ring.filled, options.tolerance);
  const float cell = 2.5f / 56;
  for (int k = 0; k < 64; ++k) {
    const double angle = 2 * pi * k / 64;
    const float inner = 0.75f - options.tolerance - cell;
    EXPECT_LT(depth_in(ring, {inner * float(std::cos(angle)), 0, inner * float(std::sin(angle))}), 0) << k;
  }
  EXPECT_LT(depth_in(ring, {0, 0, 0}), -0.5);
  for (const Vec3f& p : mesh.positions) EXPECT_GT(depth_in(ring, p), -0.02);
  EXPECT_NEAR(mass_of(ring), 1000 * 2 * pi * pi * 0.25 * 0.25, 0.05 * 1234);
}

/// A ring that is thin against the grid: whatever closes its hole is told.
TEST(Decompose, SaysIfItClosesTheHoleOfAThinRing) {
  for (const int most : {31, 128}) {
    DecomposeOptions options;
    options.most_pieces = most;
    const Decomposition ring = decompose(torus(0.1f, 0.02f, 48, 16), options);
    const bool is_open = depth_in(ring, {0, 0, 0}) < 0 && depth_in(ring, {0, -0.0185f, 0}) < 0;
    EXPECT_TRUE(is_open || ring.filled > 0.03f) << most << " pieces at most, filled " << ring.filled;
    EXPECT_TRUE(is_open || most < 128);
  }
}

TEST(Decompose, KeepsToTheGreatestNumberOfPieces) {
  DecomposeOptions options;
  options.most_pieces = 3;
  const Decomposition ring = decompose(torus(1, 0.25f, 24, 8), options);
  EXPECT_LE(ring.solids.size(), 3U);
  EXPECT_GT(ring.filled, 0.05f) << "and says how much it fills";
}

TEST(Decompose, TakesMeshesThatFaceInward) {
  TriangleMesh mesh = l_shape();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(decompose(mesh).solids.size(), 2U);
  EXPECT_NEAR(decompose(mesh).inertia.mass, 4000, 0.1);
}

TEST(Decompose, RefusesWhatHasNoInside) {
  EXPECT_THROW((void)decompose(grid_mesh(3, 3, 1, 1)), Error);
  EXPECT_THROW((void)decompose({}), Error);
  TriangleMesh wrong = l_shape();
  wrong.triangles[0][0] = 99;
  EXPECT_THROW((void)decompose(wrong), Error);
  for (const auto change :
       {+[](DecomposeOptions& o) { o.tolerance = -1; }, +[](DecomposeOptions& o) { o.most_pieces = 0; },
        +[](DecomposeOptions& o) { o.most_corners = 7; }, +[](DecomposeOptions& o) { o.density = 0; }}) {
    DecomposeOptions options;
    change(options);
    EXPECT_THROW((void)decompose(l_shape(), options), Error);
  }
}

}  // namespace
}  // namespace pliant
