// Particles that fill a closed mesh: as many as its volume holds, all inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"

namespace pliant {
namespace {

using std::numbers::pi;

double volume_of(const std::vector<Vec3f>& points, double spacing) {
  return static_cast<double>(points.size()) * spacing * spacing * spacing;
}

TriangleMesh mesh_of_shape(const SolidShape& shape) { return pliant::mesh_of({{.shape = shape}}, 128); }

TEST(FillMesh, HoldsTheVolumeOfASphereACylinderAndATurnedBox) {
  EXPECT_NEAR(volume_of(fill_mesh(mesh_of_shape(Sphere{.radius = 1}), 0.05f), 0.05) / (4 * pi / 3), 1, 0.01);
  EXPECT_NEAR(
      volume_of(fill_mesh(mesh_of_shape(Cylinder{.radius = 0.5f, .half_length = 0.5f}), 0.025f), 0.025) / (pi / 4), 1,
      0.02);
  const Quatf turn = rotation({1, 2, 3}, 37);
  const TriangleMesh box = pliant::mesh_of({{.shape = Box{{0.5f, 0.4f, 0.3f}}, .rotation = turn}}, 8);
  EXPECT_NEAR(volume_of(fill_mesh(box, 0.025f), 0.025) / (1.0 * 0.8 * 0.6), 1, 0.01);
}

TEST(FillMesh, FillsAnUprightBoxLikeFillBox) {
  const TriangleMesh box = mesh_of_shape(Box{{0.5f, 0.5f, 0.5f}});
  EXPECT_EQ(fill_mesh(box, 0.1f), fill_box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, 0.1f));
}

TEST(FillMesh, KeepsItsClearance) {
  for (const Vec3f& p : fill_mesh(mesh_of_shape(Sphere{.radius = 1}), 0.1f, 0.2f))
    EXPECT_LT(std::sqrt(length_squared(p)), 0.8f);
}

TEST(FillMesh, LeavesHollowsEmpty) {
  TriangleMesh shell = mesh_of_shape(Sphere{.radius = 1});
  const TriangleMesh hollow = mesh_of_shape(Sphere{.radius = 0.5f});
  const int first = static_cast<int>(shell.positions.size());
  shell.positions.insert(shell.positions.end(), hollow.positions.begin(), hollow.positions.end());
  for (const auto& [a, b, c] : hollow.triangles)
    shell.triangles.push_back({first + a, first + c, first + b});  // inward
  const std::vector<Vec3f> points = fill_mesh(shell, 0.05f);
  EXPECT_NEAR(volume_of(points, 0.05) / (4 * pi / 3 * 0.875), 1, 0.01);
  for (const Vec3f& p : points) EXPECT_GT(std::sqrt(length_squared(p)), 0.49f);
}

TEST(FillMesh, RefusesWhatHasNoInside) {
  TriangleMesh open = mesh_of_shape(Box{});
  open.triangles.pop_back();
  EXPECT_THROW((void)fill_mesh(open, 0.1f), Error);
  EXPECT_THROW((void)fill_mesh({}, 0.1f), Error);
  EXPECT_THROW((void)fill_mesh(mesh_of_shape(Box{}), 0), Error);
  EXPECT_THROW((void)fill_mesh(mesh_of_shape(Box{}), 0.1f, NAN), Error);
  EXPECT_THROW((void)fill_mesh(mesh_of_shape(Box{}), 0.1f, 2), Error);
  TriangleMesh wild = mesh_of_shape(Box{});
  wild.triangles.front()[0] = 99;
  EXPECT_THROW((void)fill_mesh(wild, 0.1f), Error);
}

TEST(Jittered, MovesEachPointByUpToTheLengthAndDependsOnTheSeed) {
  const std::vector<Vec3f> lattice = fill_box({0, 0, 0}, {1, 1, 1}, 0.1f), moved = jittered(lattice, 0.01f);
  ASSERT_EQ(moved.size(), lattice.size());
  float most = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vec3f by = moved[i] - lattice[i];
    for (const float along : {by.x, by.y, by.z}) most = std::max(most, std::abs(along));
  }
  EXPECT_LE(most, 0.01f + 1e-7f);
  EXPECT_GT(most, 0.0099f);
  EXPECT_EQ(moved, jittered(lattice, 0.01f));
  EXPECT_NE(moved, jittered(lattice, 0.01f, 1));
  EXPECT_EQ(lattice, jittered(lattice, 0));
  EXPECT_THROW(jittered(lattice, -1), Error);
}

}  // namespace
}  // namespace pliant
