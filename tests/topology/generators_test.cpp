// Tests generated meshes. The public header promises their numbering, on which pins rely.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/error.h"
#include "pliant/mesh.h"

namespace pliant {
namespace {

Vec3f normal_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const auto at = [&](std::size_t c) { return mesh.positions[static_cast<std::size_t>(t[c])]; };
  return cross(at(1) - at(0), at(2) - at(0));
}

TEST(GridMesh, CornersCellsAndFacing) {
  const TriangleMesh grid = grid_mesh(3, 2, 4, 6);
  ASSERT_EQ(grid.positions.size(), 6u);
  EXPECT_EQ(grid.positions[0], (Vec3f{-2, 0, -3}));
  EXPECT_EQ(grid.positions[2], (Vec3f{2, 0, -3}));
  EXPECT_EQ(grid.positions[3], (Vec3f{-2, 0, 3}));  // row 1, column 0
  ASSERT_EQ(grid.triangles.size(), 4u);
  for (const auto& triangle : grid.triangles) EXPECT_EQ(normal_of(grid, triangle), (Vec3f{0, 12, 0}));
  EXPECT_EQ(grid.triangles[0], (std::array{0, 3, 4}));  // both triangles have the diagonal (0, 0)-(1, 1)
  EXPECT_EQ(grid.triangles[1], (std::array{0, 4, 1}));
}

TEST(GridMesh, RefusesWhatHasNoTriangleOrNoSize) {
  EXPECT_THROW(grid_mesh(1, 5, 1, 1), Error);
  EXPECT_THROW(grid_mesh(5, 1, 1, 1), Error);
  EXPECT_THROW(grid_mesh(-3, 5, 1, 1), Error);
  EXPECT_THROW(grid_mesh(60000, 60000, 1, 1), Error);
  for (float bad : {0.f, -1.f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THROW(grid_mesh(5, 5, bad, 1), Error);
    EXPECT_THROW(grid_mesh(5, 5, 1, bad), Error);
  }
}

TEST(SphereMesh, LiesOnTheUnitSphereFacesOutAndFillsIt) {
  const TriangleMesh sphere = sphere_mesh(4);
  for (const Vec3f& p : sphere.positions) EXPECT_NEAR(std::sqrt(length_squared(p)), 1, 1e-6);
  double volume = 0;
  for (const auto& t : sphere.triangles) {
    const double six = dot(normal_of(sphere, t), sphere.positions[static_cast<std::size_t>(t[0])]);
    EXPECT_GT(six, 0);
    volume += six / 6;
  }
  EXPECT_NEAR(volume, 4.18879, 0.02);
}

TEST(SphereMesh, RefusesOtherSubdivisions) {
  EXPECT_THROW(sphere_mesh(-1), Error);
  EXPECT_THROW(sphere_mesh(8), Error);
  EXPECT_EQ(sphere_mesh(0).positions.size(), 12u);
}

}  // namespace
}  // namespace pliant
