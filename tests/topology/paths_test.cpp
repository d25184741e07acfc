// Tests paths through meshes: whole rows, columns and diagonals of a grid; on any mesh every edge once, no vertex twice
// in a path, no two paths of a colour with a common vertex.
#include "topology/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "pliant/mesh.h"
#include "topology/edges.h"

namespace pliant {
namespace {

using EdgeList = std::vector<std::array<int, 2>>;

EdgeList edge_list_of(const TriangleMesh& mesh) {
  EdgeList list;
  for (const Edge& edge : find_edges(mesh.triangles, static_cast<int>(mesh.positions.size())))
    list.push_back({edge.a, edge.b});
  return list;
}

void expect_sound(const std::vector<Vec3f>& positions, const EdgeList& edges) {
  std::vector<int> times(edges.size(), 0);
  for (const PathColour& colour : lay_paths(positions, edges)) {
    std::set<int> met;
    std::size_t longest = edges.size();
    for (const Path& path : colour.paths) {
      ASSERT_GE(path.edges.size(), 1u);
      ASSERT_EQ(path.vertices.size(), path.edges.size() + 1);
      ASSERT_LE(path.edges.size(), longest) << "longest first";
      longest = path.edges.size();
      for (int v : path.vertices) ASSERT_TRUE(met.insert(v).second) << "vertex " << v << " twice in a colour";
      for (std::size_t k = 0; k < path.edges.size(); ++k) {
        const auto [a, b] = std::minmax(path.vertices[k], path.vertices[k + 1]);
        const auto& edge = edges[path.edges[k]];
        ASSERT_EQ(a, std::min(edge[0], edge[1]));
        ASSERT_EQ(b, std::max(edge[0], edge[1]));
        ++times[path.edges[k]];
      }
    }
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(edges.size()));
}

TEST(Paths, of_a_grid_are_diagonals_then_rows_and_columns) {
  constexpr int n = 9;
  const TriangleMesh mesh = grid_mesh(n, n, 1, 1);
  const std::vector<PathColour> colours = lay_paths(mesh.positions, edge_list_of(mesh));
  ASSERT_EQ(colours.size(), 3u);
  ASSERT_EQ(colours[0].paths.size(), 2u * n - 3);
  EXPECT_EQ(colours[0].paths[0].vertices, (std::vector<int>{0, 10, 20, 30, 40, 50, 60, 70, 80}));
  for (int c : {1, 2}) {
    ASSERT_EQ(colours[c].paths.size(), static_cast<std::size_t>(n));
    const int step = c == 1 ? 1 : n, first = c == 1 ? n : 1;
    for (int p = 0; p < n; ++p) {
      const std::vector<int>& vertices = colours[c].paths[p].vertices;
      ASSERT_EQ(vertices.size(), static_cast<std::size_t>(n));
      for (int k = 0; k < n; ++k) EXPECT_EQ(vertices[k], p * first + k * step);
    }
  }
}

TEST(Paths, of_any_mesh_hold_every_edge_once) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh = round % 2 == 0 ? grid_mesh(3 + round, 20 - round / 2, 1, 2) : sphere_mesh(round % 4);
    for (Vec3f& p : mesh.positions) {
      for (float* x : {&p.x, &p.y, &p.z}) *x += static_cast<float>(random() % 1000) * 4e-5f;
    }
    ASSERT_NO_FATAL_FAILURE(expect_sound(mesh.positions, edge_list_of(mesh)));
  }
}

TEST(Paths, go_on_round_a_bend_and_not_round_a_corner) {
  for (const auto& [degrees, paths] : {std::pair{30.0, 1U}, {44.0, 1U}, {46.0, 2U}, {60.0, 2U}, {120.0, 2U}}) {
    const double turn = degrees * 3.14159265358979 / 180;
    const std::vector<Vec3f> bent{
        {0, 0, 0}, {1, 0, 0}, {1 + static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)), 0}};
    std::size_t found = 0;
    for (const PathColour& colour : lay_paths(bent, {{0, 1}, {1, 2}})) found += colour.paths.size();
    EXPECT_EQ(found, paths) << degrees << " degrees";
  }
}

TEST(Paths, of_a_hub_go_straight_through_it) {
  constexpr int spokes = 12;
  std::vector<Vec3f> hub{{}};
  EdgeList edges;
  for (int i = 0; i < spokes; ++i) {
    const float t = 6.2831853f * static_cast<float>(i) / spokes;
    hub.push_back({std::cos(t), std::sin(t), 0});
    edges.push_back({0, i + 1});
  }
  for (const PathColour& colour : lay_paths(hub, edges)) {
    ASSERT_EQ(colour.paths.size(), 1U) << "all meet in the middle";
    EXPECT_EQ(colour.paths[0].edges.size(), 2U);
    EXPECT_EQ(std::abs(colour.paths[0].vertices[0] - colour.paths[0].vertices[2]), spokes / 2);
  }
}

TEST(Paths, of_a_colour_run_the_same_way) {
  const std::vector<Vec3f> there_and_back{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<PathColour> colours = lay_paths(there_and_back, {{0, 1}, {1, 2}, {3, 4}, {4, 5}});
  ASSERT_EQ(colours.size(), 1U);
  ASSERT_EQ(colours[0].paths.size(), 2U);
  EXPECT_EQ(colours[0].paths[0].vertices, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(colours[0].paths[1].vertices, (std::vector<int>{5, 4, 3}));
}

TEST(Paths, of_knots_end_where_they_would_meet_themselves) {
  std::vector<Vec3f> ring;
  EdgeList edges;
  for (int i = 0; i < 24; ++i) {  // a circle: angles of 15 degrees, and no end
    const float t = static_cast<float>(i) * 0.2617994f;
    ring.push_back({std::cos(t), std::sin(t), 0});
    edges.push_back({i, (i + 1) % 24});
  }
  ASSERT_NO_FATAL_FAILURE(expect_sound(ring, edges));
  const std::vector<Vec3f> line(5, Vec3f{});  // all at one position
  ASSERT_NO_FATAL_FAILURE(expect_sound(line, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {1, 2}}));
  EXPECT_TRUE(lay_paths(line, {}).empty());
}

TEST(Paths, of_a_spider_do_not_take_for_ever) {
  std::vector<Vec3f> positions{{}};
  EdgeList edges;
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<float>(random() % 2001) * 1e-3f - 1; };
  for (int i = 1; i <= 20000; ++i) {
    positions.push_back({number(), number(), number()});
    edges.push_back({0, i});
  }
  ASSERT_NO_FATAL_FAILURE(expect_sound(positions, edges));
}

}  // namespace
}  // namespace pliant
