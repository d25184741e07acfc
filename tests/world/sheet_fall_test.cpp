// Tests that fine sheets that fall on an edge, with few fixed substeps, keep the lengths of their edges: where layers
// move fast side by side, the filter truncated the steps of single particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/at.h"
#include "pliant/mesh.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr double edge_of_sheet = 0.003;
constexpr int edges_a_side = 30;

/// A square whose inner vertices are moved by up to a quarter of an edge, turned about the vertical.
TriangleMesh moved_square(unsigned seed, double turn, double height) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return 0.25 * (static_cast<double>(random() % 65536) / 32768 - 1); };
  const int count = edges_a_side + 1;
  TriangleMesh mesh;
  mesh.positions.reserve(at(count * count));
  mesh.triangles.reserve(at(2 * edges_a_side * edges_a_side));
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const bool is_inner = i > 0 && j > 0 && i < edges_a_side && j < edges_a_side;
      const double x = (i - edges_a_side / 2.0 + (is_inner ? uniform() : 0)) * edge_of_sheet;
      const double z = (j - edges_a_side / 2.0 + (is_inner ? uniform() : 0)) * edge_of_sheet;
      mesh.positions.push_back({static_cast<float>(x * std::cos(turn) - z * std::sin(turn)), static_cast<float>(height),
                                static_cast<float>(x * std::sin(turn) + z * std::cos(turn))});
    }
  for (int i = 0; i < edges_a_side; ++i)
    for (int j = 0; j < edges_a_side; ++j) {
      const int a = i * count + j, b = a + count, c = b + 1, d = a + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// A box whose upper edge is the line x = y = 0, as triangles.
MeshCollider box_of_triangles() {
  MeshCollider box;
  for (const float z : {-0.1f, 0.1f})
    for (const float y : {-0.1f, 0.f})
      for (const float x : {0.f, 0.2f}) box.mesh.positions.push_back({x, y, z});
  box.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// The largest overstretch of any frame while a sheet falls 0.12 m on the edge of a box and slides off.
double largest_in_fall(int substeps, unsigned seed, double turn, bool on_triangles) {
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(moved_square(seed, turn, 0.12), options);
  cloth.self_collision = true;
  Scene scene;
  scene.settings.substeps = substeps;
  scene.add(cloth);
  if (on_triangles) {
    scene.mesh_colliders.push_back(box_of_triangles());
  } else {
    Collider box;
    box.shape = Box{{0.1f, 0.05f, 0.1f}};
    box.position = {0.1f, -0.05f, 0};
    scene.colliders.push_back(box);
  }
  World world(scene);
  double largest = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const Report report = world.step(1.f / 60);
    EXPECT_TRUE(report.ok());
    if (report.overstretch) largest = std::max(largest, double(report.overstretch->largest));
  }
  return largest;
}

TEST(SheetFall, KeepsLengthsWhereItFallsOnAnEdge) {
  for (const unsigned seed : {2u, 3u, 4u})
    for (const double turn : {0.0, 0.4})
      for (const bool on_triangles : {false, true}) {
        EXPECT_LT(largest_in_fall(12, seed, turn, on_triangles), 0.25) << seed << ", " << turn << ", " << on_triangles;
        EXPECT_LT(largest_in_fall(20, seed, turn, on_triangles), 0.12) << seed << ", " << turn << ", " << on_triangles;
      }
}

}  // namespace
}  // namespace pliant
