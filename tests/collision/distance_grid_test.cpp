// Compares distance grids with solids whose distance is known: a sphere, and a box seen from all sides.
#include "collision/fields/distance_grid.h"

#include <gtest/gtest.h>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using testing_support::random_vector;

TriangleMesh box_mesh() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.75f : -0.75f});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(DistanceGrid, OfASphereIsItsRadius) {
  Executor executor(2);
  const TriangleMesh mesh = sphere_mesh(4);
  const DistanceGrid grid(MeshQuery(mesh.positions, mesh.triangles), 0.07f, 0.3f, executor);
  std::mt19937_64 random(81);
  for (int i = 0; i < 5000; ++i) {
    const Vec3f p = random_vector(random, 1.25f);
    const double r = length(convert<double>(p));
    const auto found = grid.sample(p);
    ASSERT_NEAR(found.distance, r - 1, r < 0.3 ? 0.03 : 0.006) << r;  // at the centre the distance has a kink
    ASSERT_NEAR(length(found.normal), 1, 1e-5);
    if (r > 0.3) {
      ASSERT_GT(dot(convert<double>(found.normal), convert<double>(p)) / r, 0.98);
    }
    const float eps = 1e-3f;  // the distance grows at a rate of one along the normal
    if (r > 0.3) {
      ASSERT_NEAR(grid.sample(p + found.normal * eps).distance - grid.sample(p - found.normal * eps).distance, 2 * eps,
                  3e-4);
    }
  }
}

TEST(DistanceGrid, OfABoxIsThatOfTheBoxInsideAndOutside) {
  Executor executor(1);
  const TriangleMesh mesh = box_mesh();
  const DistanceGrid grid(MeshQuery(mesh.positions, mesh.triangles), 0.04f, 0.2f, executor);
  const LocalShape box{ShapeKind::box, 1, 0.5f, 0.75f};
  std::mt19937_64 random(82);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3f p = random_vector(random, 1.15f);
    const float exact = signed_distance(box, p).distance;
    inside += exact < 0;
    const bool in_grid = overlap(BoxBounds{p, p}, grid.bounds());
    if (in_grid) {
      ASSERT_NEAR(grid.sample(p).distance, exact, 0.02f);
    } else {
      ASSERT_GE(grid.sample(p).distance, exact - 0.02f);
    }
  }
  EXPECT_GT(inside, 500);
  const auto beyond = grid.sample({11, 0, 0});
  EXPECT_NEAR(beyond.distance, 10, 0.05);
  EXPECT_NEAR(beyond.normal.x, 1, 1e-3);
}

TEST(DistanceGrid, IsTheSameOnAnyThreads) {
  const TriangleMesh mesh = sphere_mesh(2);
  const MeshQuery query(mesh.positions, mesh.triangles);
  Executor one(1), four(4);
  const DistanceGrid first(query, 0.1f, 0.1f, one), second(query, 0.1f, 0.1f, four);
  std::mt19937_64 random(83);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f p = random_vector(random, 1.5f);
    ASSERT_EQ(first.sample(p).distance, second.sample(p).distance);
  }
}

TEST(DistanceGrid, RefusesOpenMeshesAndSenselessSizes) {
  Executor executor(1);
  const TriangleMesh sheet = grid_mesh(3, 3, 1, 1), ball = sphere_mesh(1);
  const MeshQuery open(sheet.positions, sheet.triangles), closed(ball.positions, ball.triangles);
  EXPECT_THROW(DistanceGrid(open, 0.1f, 0, executor), Error);
  EXPECT_THROW(DistanceGrid(MeshQuery({}, {}), 0.1f, 0, executor), Error);
  EXPECT_THROW(DistanceGrid(closed, 0, 0, executor), Error);
  EXPECT_THROW(DistanceGrid(closed, 0.1f, -1, executor), Error);
  EXPECT_THROW(DistanceGrid(closed, 1e-6f, 0, executor), Error);
}

}  // namespace
}  // namespace pliant
