// How much softer a mesh of springs is than its modulus says: not at all if it is regular, flat or rolled, and the same
// however it lies in space.
#include "matter/irregular_springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "support/random.h"

namespace pliant {
namespace {

using testing_support::Random;
using testing_support::uniform;

/// The softness of a mesh whose positions go through a map.
double softness(const TriangleMesh& mesh, const std::function<Vec3d(const Vec3d&)>& map) {
  std::vector<Vec3d> positions;
  for (const Vec3f& p : mesh.positions) positions.push_back(map(convert<double>(p)));
  const std::vector<Edge> edges = find_edges(mesh.triangles, static_cast<int>(positions.size()));
  std::vector<double> areas;
  for (const Edge& edge : edges) {
    double area = 0;
    for (const int opposite : edge.opposites) {
      if (opposite < 0) continue;
      const auto at = [&](int v) { return positions[static_cast<std::size_t>(v)]; };
      area += std::sqrt(length_squared(cross(at(edge.b) - at(edge.a), at(opposite) - at(edge.a)))) / 2;
    }
    areas.push_back(area);
  }
  return softness_of({positions, mesh.triangles, edges, areas});
}

double softness(const TriangleMesh& mesh) {
  return softness(mesh, [](const Vec3d& p) { return p; });
}

Vec3d rolled(const Vec3d& p) { return {0.4 * std::sin(p.x / 0.4), 0.4 * std::cos(p.x / 0.4), p.z}; }

/// A grid of 30 x 20 cells of 1 cm, inner vertices moved by up to `by` cells.
TriangleMesh moved_grid(double by) {
  Random random(2);
  TriangleMesh mesh = grid_mesh(31, 21, 0.3f, 0.2f);
  for (Vec3f& p : mesh.positions) {
    if (std::fabs(p.x) > 0.149f || std::fabs(p.z) > 0.099f) continue;
    p.x += static_cast<float>(uniform(random, -0.01 * by, 0.01 * by));
    p.z += static_cast<float>(uniform(random, -0.01 * by, 0.01 * by));
  }
  return mesh;
}

/// A grid whose diagonals alternate.
TriangleMesh alternating() {
  TriangleMesh mesh = grid_mesh(13, 13, 1, 1);
  for (std::size_t cell = 0; 2 * cell < mesh.triangles.size(); ++cell) {
    if ((cell / 12 + cell % 12) % 2 == 0) continue;
    const int corner = static_cast<int>(cell / 12 * 13 + cell % 12);
    mesh.triangles[2 * cell] = {corner, corner + 13, corner + 1};
    mesh.triangles[2 * cell + 1] = {corner + 1, corner + 13, corner + 14};
  }
  return mesh;
}

TEST(IrregularSprings, RegularMeshesAreAsStiffAsTheirModulusSays) {
  const TriangleMesh grid = grid_mesh(31, 21, 0.3f, 0.2f);
  EXPECT_EQ(softness(grid), 1);
  EXPECT_EQ(softness(grid, rolled), 1);
  EXPECT_EQ(softness(grid, [](const Vec3d& p) { return Vec3d{p.x, 0, 5 * p.z}; }), 1);
  EXPECT_EQ(softness(grid, [](const Vec3d& p) { return Vec3d{p.x + 0.5 * p.z, 0, 0.87 * p.z}; }), 1);
  EXPECT_EQ(softness(alternating()), 1);
  EXPECT_EQ(softness(sphere_mesh(3)), 1);
  EXPECT_EQ(softness({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), 1);
}

TEST(IrregularSprings, GrowsWithIrregularity) {
  EXPECT_EQ(softness(moved_grid(0.05)), 1);  // 1.005: below what is looked at
  EXPECT_NEAR(softness(moved_grid(0.2)), 1.075, 0.01);
  EXPECT_NEAR(softness(moved_grid(0.25)), 1.12, 0.01);
}

TEST(IrregularSprings, DoesNotDependOnPlaceSizeOrRolling) {
  const TriangleMesh mesh = moved_grid(0.25);
  const double flat = softness(mesh);
  EXPECT_NEAR(softness(mesh, rolled), flat, 0.002);
  EXPECT_NEAR(softness(mesh, [](const Vec3d& p) { return 1e-4 * p; }), flat, 1e-9);
  EXPECT_NEAR(softness(mesh, [](const Vec3d& p) { return 1e4 * p + Vec3d{1e6, 0, 0}; }), flat, 1e-6);
  const Vec3d u{0.6, 0.48, 0.64}, v{-0.8, 0.36, 0.48};
  EXPECT_NEAR(softness(mesh, [&](const Vec3d& p) { return p.x * u + p.z * v; }), flat, 1e-4);
}

TEST(IrregularSprings, SliversStayWithinTheLargestFactor) {
  TriangleMesh mesh = moved_grid(0.25);
  for (Vec3f& p : mesh.positions) p.z = p.z > 0 ? p.z * p.z * p.z : p.z;
  const double soft = softness(mesh);
  EXPECT_GT(soft, softness(moved_grid(0.25)));
  EXPECT_LE(soft, 2);
}

TEST(IrregularSprings, ClothOfAGridHasTheStiffnessOfItsCells) {
  ClothOptions options;
  options.material.stretch_stiffness = 300;
  const TriangleMesh mesh = grid_mesh(14, 9, 0.7f, 0.3f);
  const Object cloth = make_cloth(mesh, options);
  const ConstraintGroup& springs = cloth.constraints[0];
  const double cell = 0.7 / 13 * 0.3 / 8;  // an inner edge is beside two halves of a cell
  for (std::size_t e = 0; e < springs.compliances.size(); ++e) {
    const double length = static_cast<double>(springs.rest[e]),
                 compliance = static_cast<double>(springs.compliances[e]);
    const double ratio = compliance * 300 * cell / (length * length);
    EXPECT_NEAR(ratio > 1.5 ? ratio / 2 : ratio, 1, 1e-5);
  }
}

TEST(IrregularSprings, ClothIsStiffenedByTheSoftnessOfItsMesh) {
  ClothOptions options;
  options.material.stretch_stiffness = 300;
  const TriangleMesh mesh = moved_grid(0.25);
  const double soft = softness(mesh);
  double energy = 0;  // of a dilation by 1: 3/2 Y A, times the softness
  const ConstraintGroup springs = make_cloth(mesh, options).constraints[0];
  for (std::size_t e = 0; e < springs.compliances.size(); ++e) {
    const double length = static_cast<double>(springs.rest[e]);
    energy += length * length / (2 * static_cast<double>(springs.compliances[e]));
  }
  EXPECT_NEAR(energy, 1.5 * 300 * 0.3 * 0.2 * soft, 1e-5 * energy);
  options.stretch = Stiffness::compliance(1e-5f);  // a compliance of edges is left as it is
  EXPECT_EQ(make_cloth(mesh, options).constraints[0].stiffness.value, 1e-5f);
  EXPECT_TRUE(make_cloth(mesh, options).constraints[0].compliances.empty());
}

}  // namespace
}  // namespace pliant
