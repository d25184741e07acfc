// Compares closest points and inside tests with brute force and with solids that are known.
#include "collision/fields/mesh_query.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/exact.h"
#include "pliant/mesh.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using testing_support::random_vector;

/// A cube of half size 1 whose corners are exact in float, so that its planes are exact.
TriangleMesh cube(const Vec3f& middle = {}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(middle + Vec3f{i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(MeshQuery, FindsTheClosestPointAsBruteForceDoes) {
  const TriangleMesh mesh = sphere_mesh(3);
  const MeshQuery query(mesh.positions, mesh.triangles);
  std::mt19937_64 random(41);
  for (int i = 0; i < 500; ++i) {
    const Vec3f p = random_vector(random, 2);
    double least = 1e9;
    for (const Triangle& t : mesh.triangles) {
      const auto corner = [&](std::size_t k) {
        return convert<double>(mesh.positions[static_cast<std::size_t>(t[k])]);
      };
      least = std::min(
          least, std::sqrt(closest_on_triangle(convert<double>(p), corner(0), corner(1), corner(2)).distance_squared));
    }
    const SurfacePoint found = query.closest(p);
    ASSERT_NEAR(found.distance, least, 1e-6);
    ASSERT_NEAR(length(convert<double>(p) - convert<double>(found.point)), least, 1e-6);
    ASSERT_EQ(query.closest(p, static_cast<float>(least) * 0.99f).triangle, -1);
    ASSERT_EQ(query.closest(p, static_cast<float>(least) * 1.01f).triangle, found.triangle);
  }
}

TEST(MeshQuery, KnowsTheInsideOfASphereAndOfACubeSeenAlongItsEdges) {
  const TriangleMesh sphere = sphere_mesh(3), box = cube();
  const MeshQuery in_sphere(sphere.positions, sphere.triangles), in_box(box.positions, box.triangles);
  std::mt19937_64 random(42);
  for (int i = 0; i < 3000; ++i) {
    const Vec3f p = random_vector(random, 1.5f);
    const double r = length(convert<double>(p));
    if (r < 0.98 || r > 1) {
      ASSERT_EQ(in_sphere.winding_number(p), r < 1 ? 1 : 0);
    }
    // Coordinates are multiples of a half, so that rays in simple directions would run along edges and diagonals and
    // through corners.
    const Vec3f q{static_cast<float>(static_cast<int>(p.x * 4)) / 2, static_cast<float>(static_cast<int>(p.y * 4)) / 2,
                  static_cast<float>(static_cast<int>(p.z * 4)) / 2};
    ASSERT_EQ(in_box.is_inside(q), largest(q) < 1) << q.x << ' ' << q.y << ' ' << q.z;
  }
}

TEST(MeshQuery, CountsShellsAndTheirSense) {
  TriangleMesh two = cube(), second = cube({1, 1, 1});
  for (const Triangle& t : second.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.positions.insert(two.positions.end(), second.positions.begin(), second.positions.end());
  const MeshQuery query(two.positions, two.triangles);
  EXPECT_EQ(query.winding_number({0.5f, 0.5f, 0.5f}), 2);
  EXPECT_EQ(query.winding_number({-0.5f, 0.5f, 0.5f}), 1);
  EXPECT_EQ(query.winding_number({-0.5f, 1.5f, 0.5f}), 0);
  TriangleMesh turned = cube();
  for (Triangle& t : turned.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(MeshQuery(turned.positions, turned.triangles).winding_number({0.1f, 0, 0}), -1);
  EXPECT_EQ(MeshQuery({}, {}).winding_number({0, 0, 0}), 0);
  EXPECT_EQ(MeshQuery({}, {}).closest({0, 0, 0}).triangle, -1);
}

TEST(MeshQuery, GivesUpRaysThatTouch) {
  // A cube, and in it a tetrahedron with a corner exactly on the first ray from the origin, which ends at 16 v.
  TriangleMesh mesh = cube();
  const float step = 13;
  const Vec3f v{step / 16, step * 0.0137f / 16, step * 0.0291f / 16};
  for (const Vec3f& corner : {v, v + Vec3f{0.1f, 0, 0}, v + Vec3f{0.1f, 0.1f, 0}, v + Vec3f{0.1f, 0, 0.1f}})
    mesh.positions.push_back(corner);
  for (const Triangle& t : {Triangle{8, 9, 10}, Triangle{8, 11, 9}, Triangle{8, 10, 11}, Triangle{9, 11, 10}})
    mesh.triangles.push_back(t);
  EXPECT_EQ(how_edge_meets_triangle({{0, 0, 0}, 16.f * v}, {v, v + Vec3f{0.1f, 0, 0}, v + Vec3f{0.1f, 0.1f, 0}}),
            EdgeTriangle::touching);
  EXPECT_EQ(MeshQuery(mesh.positions, mesh.triangles).winding_number({0, 0, 0}), 1);
}

TEST(MeshQuery, FollowsItsMesh) {
  TriangleMesh mesh = cube();
  MeshQuery query(mesh.positions, mesh.triangles);
  for (Vec3f& p : mesh.positions) p = p + Vec3f{10, 0, -1000};
  query.move(mesh.positions);
  EXPECT_TRUE(query.is_inside({10.5f, 0.2f, -1000.3f}));
  EXPECT_FALSE(query.is_inside({0, 0, 0}));
  EXPECT_NEAR(query.closest({10, 3, -1000}).distance, 2, 1e-6);
}

}  // namespace
}  // namespace pliant
