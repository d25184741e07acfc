// Tests distances within a mesh: the straight line on flat meshes, whatever their triangles; across a fold; groups.
#include "topology/geodesics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "pliant/mesh.h"
#include "topology/edges.h"

namespace pliant {
namespace {

double distance(const Vec3f& a, const Vec3f& b) {
  const double x = double(a.x) - b.x, y = double(a.y) - b.y, z = double(a.z) - b.z;
  return std::sqrt(x * x + y * y + z * z);
}

Distances distances_of(const TriangleMesh& mesh) {
  Distances of{static_cast<int>(mesh.positions.size()), {}, {}, mesh.triangles};
  for (const Edge& edge : find_edges(mesh.triangles, of.vertices)) {
    of.edges.push_back({edge.a, edge.b});
    of.lengths.push_back(static_cast<float>(distance(mesh.positions[edge.a], mesh.positions[edge.b])));
  }
  return of;
}

TEST(Geodesics, on_a_flat_sheet_are_straight) {
  TriangleMesh mesh = grid_mesh(17, 13, 1.3f, 1);
  std::mt19937 random(5);
  for (int shaken : {0, 1}) {
    for (Vec3f& p : mesh.positions) {
      p.x += static_cast<float>(shaken) * static_cast<float>(random() % 100) * 2e-4f;
      p.z += static_cast<float>(shaken) * static_cast<float>(random() % 100) * 2e-4f;
    }
    const int corner = 16, other = 17 * 12;
    const auto found = nearest_sources(distances_of(mesh), {corner, other}, 4);
    double worst = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      ASSERT_EQ(found[v].size(), 2u);
      for (const NearSource& near : found[v]) {
        const double straight = distance(mesh.positions[v], mesh.positions[near.source]);
        EXPECT_GE(near.distance, straight * (1 - 1e-5));
        worst = std::max(worst, near.distance - straight);
      }
      EXPECT_LE(found[v][0].distance, found[v][1].distance);
    }
    // A displaced border is not convex, so the shortest line may have to go round a dent.
    EXPECT_LT(worst, shaken == 0 ? 1e-5 : 0.01);
  }
}

TEST(Geodesics, go_round_a_corner_that_is_cut_out) {
  TriangleMesh mesh =
      grid_mesh(9, 9, 8, 8);  // vertex (row r, column c) is 9 r + c; vertices beyond row 4 and column 4 are removed
  const auto is_cut = [](const std::array<int, 3>& t) {
    return std::all_of(t.begin(), t.end(), [](int v) { return v / 9 >= 4 && v % 9 >= 4; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_cut), mesh.triangles.end());
  const int corner = 9 * 4 + 4;
  for (const auto& [from, to] : {std::pair{9 * 4 + 8, 9 * 8 + 4}, {9 * 2 + 8, 9 * 8 + 2}, {9 * 3 + 8, 9 * 8 + 0}}) {
    const auto found = nearest_sources(distances_of(mesh), {from}, 4);
    const double way =
        distance(mesh.positions[from], mesh.positions[corner]) + distance(mesh.positions[corner], mesh.positions[to]);
    ASSERT_EQ(found[to].size(), 1U);
    EXPECT_GT(found[to][0].distance, way - 1e-4) << "through the air";
    EXPECT_LT(found[to][0].distance, 1.05 * way);
  }
}

TEST(Geodesics, without_triangles_follow_the_edges) {
  Distances line{5, {{0, 1}, {1, 2}, {2, 3}}, {1, 2, 4}, {}};
  const auto found = nearest_sources(line, {0}, 4);
  EXPECT_EQ(found[0][0].distance, 0);
  EXPECT_EQ(found[3][0].distance, 7);
  EXPECT_TRUE(found[4].empty()) << "nothing leads there";
}

TEST(Geodesics, count_a_hem_once_and_keep_the_nearest_groups) {
  Distances line{9, {}, {}, {}};
  for (int i = 0; i < 8; ++i) {
    line.edges.push_back({i, i + 1});
    line.lengths.push_back(1);
  }
  const auto hem = nearest_sources(line, {0, 1, 8}, 4);  // 0 and 1 are joined, so they form one group
  ASSERT_EQ(hem[5].size(), 2u);
  EXPECT_EQ(hem[5][0].source, 8);
  EXPECT_EQ(hem[5][1].source, 1);
  EXPECT_EQ(hem[5][1].distance, 4);
  const auto nearest = nearest_sources(line, {0, 4, 8}, 1);
  ASSERT_EQ(nearest[3].size(), 1u);
  EXPECT_EQ(nearest[3][0].source, 4);
}

}  // namespace
}  // namespace pliant
