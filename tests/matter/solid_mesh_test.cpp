// Tests the meshes of solids: closed, outward, and of the volume of the solid.
#include <gtest/gtest.h>

#include <map>

#include "pliant/body.h"
#include "pliant/error.h"

namespace pliant {
namespace {

double signed_volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six += static_cast<double>(
        dot(mesh.positions[static_cast<std::size_t>(a)],
            cross(mesh.positions[static_cast<std::size_t>(b)], mesh.positions[static_cast<std::size_t>(c)])));
  return six / 6;
}

/// Each edge belongs to two triangles, which use it in opposite directions.
void expect_closed(const TriangleMesh& mesh, const char* what) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      EXPECT_NE(a, b) << what;
      ++edges[{a, b}];
    }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << what;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << what;
  }
}

/// The mass of make_body is that of the exact solid.
TEST(SolidMesh, IsClosedAndHasTheVolumeOfItsSolid) {
  const Hull wedge{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0.2f, 0.2f, 0.2f}}, 0};
  const std::vector<std::pair<const char*, SolidShape>> shapes{
      {"sphere", Sphere{0.7f}},           {"capsule", Capsule{0.3f, 0.8f}}, {"box", Box{{0.2f, 0.4f, 0.6f}}},
      {"cylinder", Cylinder{0.5f, 0.3f}}, {"cone", Cone{0.5f, 0.6f}},       {"hull", wedge}};
  for (const auto& [what, shape] : shapes) {
    const Solid solid{shape, {0.3f, -2, 1}, rotation({1, 2, 3}, 40), 1};
    const TriangleMesh mesh = mesh_of({solid}, 256);
    expect_closed(mesh, what);
    const double volume = static_cast<double>(make_body({solid}).masses[0]);
    EXPECT_NEAR(signed_volume(mesh), volume, 1e-3 * volume) << what;
  }
}

TEST(SolidMesh, HasRoundVerticesOnTheSurface) {
  for (const Vec3f& p : mesh_of({{Sphere{2}, {1, 0, 0}}}).positions)
    EXPECT_NEAR(length_squared(p - Vec3f{1, 0, 0}), 4, 1e-5);
  const TriangleMesh cylinder = mesh_of({{Cylinder{1, 2}, {}, {}}}, 16);
  EXPECT_EQ(cylinder.positions.size(), 34U);
  EXPECT_EQ(cylinder.triangles.size(), 64U);
}

TEST(SolidMesh, OfAHullWithAMarginIsGrown) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({(i & 1) != 0 ? 1.f : -1.f, (i & 2) != 0 ? 1.f : -1.f, (i & 4) != 0 ? 1.f : -1.f});
  const TriangleMesh mesh = mesh_of({{Hull{corners, 0.25f}}});
  expect_closed(mesh, "hull with a margin");
  // The box, six slabs, twelve quarters of cylinders and a ball; the mesh is inside it.
  const double exact = 8 + 6 * 4 * 0.25 + 3 * 2 * 3.14159265 * 0.0625 + 4.18879 * 0.015625;
  EXPECT_LT(signed_volume(mesh), exact);
  EXPECT_GT(signed_volume(mesh), 0.97 * exact);
}

TEST(SolidMesh, HasAllSolidsOfABody) {
  const TriangleMesh mesh = mesh_of({{Box{}, {-2, 0, 0}}, {Box{{0.5f, 1, 1}}, {2, 0, 0}}});
  EXPECT_EQ(mesh.positions.size(), 16U);
  EXPECT_NEAR(signed_volume(mesh), 1 + 4, 1e-6);
  EXPECT_TRUE(mesh_of({}).positions.empty());
}

TEST(SolidMesh, RefusesFlatHullsAndTooFewSegments) {
  EXPECT_THROW(static_cast<void>(mesh_of({{Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}})), Error);
  EXPECT_THROW(static_cast<void>(mesh_of({{Sphere{}}}, 4)), Error);
}

}  // namespace
}  // namespace pliant
