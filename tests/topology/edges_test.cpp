// Compares edges, hinges and global properties of surfaces with brute force, and with meshes whose answers follow from
// Euler's formula.
#include "topology/edges.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "topology/boundary.h"

namespace pliant {
namespace {

int count_of(const std::vector<Vec3f>& positions) { return static_cast<int>(positions.size()); }

std::vector<Edge> edges_of(const TriangleMesh& mesh) { return find_edges(mesh.triangles, count_of(mesh.positions)); }

/// A band of `quads` quads whose ends are joined, after half a turn if `twisted`.
std::vector<Triangle> band(int quads, bool twisted) {
  std::vector<Triangle> triangles;
  for (int q = 0; q < quads; ++q) {
    const bool last = q + 1 == quads;
    const int low = 2 * q, high = 2 * q + 1;
    const int next_low = last ? (twisted ? 1 : 0) : low + 2, next_high = last ? (twisted ? 0 : 1) : high + 2;
    triangles.push_back({low, next_low, next_high});
    triangles.push_back({low, next_high, high});
  }
  return triangles;
}

TEST(Edges, EachPropertyOfOneTriangle) {
  const std::vector<Edge> edges = find_edges({{2, 0, 1}}, 3);
  ASSERT_EQ(edges.size(), 3u);
  EXPECT_EQ(edges[0].a, 0);
  EXPECT_EQ(edges[0].b, 1);
  EXPECT_EQ(edges[0].opposites[0], 2);
  EXPECT_TRUE(edges[0].forward[0]);
  EXPECT_EQ(edges[1].b, 2);
  EXPECT_FALSE(edges[1].forward[0]);  // the triangle traverses the edge 2 -> 0
  EXPECT_EQ(edges[1].opposites[1], -1);
  EXPECT_TRUE(edges[2].is_border());
}

TEST(Edges, BruteForceOnRandomTriangles) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    const int vertices = 3 + static_cast<int>(random() % 12);
    std::vector<Triangle> triangles(random() % 25);
    for (Triangle& t : triangles)
      for (int& v : t) v = static_cast<int>(random() % static_cast<unsigned>(vertices));
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>>
        expected;  // key: edge; value: its triangles and opposite corners, in order
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const int from = triangles[t][c], to = triangles[t][(c + 1) % 3];
        if (from != to) expected[std::minmax(from, to)].push_back({static_cast<int>(t), triangles[t][(c + 2) % 3]});
      }
    const std::vector<Edge> edges = find_edges(triangles, vertices);
    ASSERT_EQ(edges.size(), expected.size());
    std::size_t e = 0;
    for (const auto& [ends, users] : expected) {  // std::map is sorted, as edges must be
      const Edge& edge = edges[e++];
      ASSERT_EQ(std::make_pair(edge.a, edge.b), ends);
      ASSERT_EQ(edge.triangle_count, static_cast<int>(users.size()));
      for (std::size_t i = 0; i < std::min<std::size_t>(2, users.size()); ++i) {
        ASSERT_EQ(edge.triangles[i], users[i].first);
        ASSERT_EQ(edge.opposites[i], users[i].second);
      }
    }
  }
}

TEST(Edges, EulersFormula) {
  for (int subdivisions = 0; subdivisions <= 4; ++subdivisions) {
    const TriangleMesh sphere = sphere_mesh(subdivisions);
    const std::vector<Edge> edges = edges_of(sphere);
    EXPECT_EQ(sphere.positions.size() - edges.size() + sphere.triangles.size(), 2u);
    EXPECT_EQ(sphere.triangles.size(), 20u << (2 * subdivisions));
    EXPECT_TRUE(is_closed(edges));
    EXPECT_TRUE(is_wound_consistently(edges));
    EXPECT_EQ(find_hinges(edges).size(), edges.size());
  }
}

TEST(Edges, GridHasTheEdgesAndHingesOfW1) {
  const TriangleMesh grid = grid_mesh(64, 48, 1, 1);
  const std::vector<Edge> edges = edges_of(grid);
  EXPECT_EQ(edges.size(), 63u * 48 + 64 * 47 + 63 * 47);
  EXPECT_EQ(find_hinges(edges).size(), edges.size() - 2 * (63 + 47));
  EXPECT_FALSE(is_closed(edges));
  EXPECT_TRUE(is_edge_manifold(edges));
  const auto loops = boundary_loops(edges, count_of(grid.positions));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].size(), 2u * (63 + 47));
}

TEST(Edges, HingeRunsForwardInTheTriangleOfItsThirdCorner) {
  const TriangleMesh sphere = sphere_mesh(2);
  for (const Edge& edge : edges_of(sphere)) {
    const Hinge hinge = hinge_of(edge);
    bool found = false;
    for (std::size_t side = 0; side < 2; ++side) {
      const Triangle& t = sphere.triangles[static_cast<std::size_t>(edge.triangles[side])];
      for (std::size_t c = 0; c < 3; ++c)
        found |= t[c] == hinge.v0 && t[(c + 1) % 3] == hinge.v1 && t[(c + 2) % 3] == hinge.v2;
    }
    EXPECT_TRUE(found);
    EXPECT_NE(hinge.v2, hinge.v3);
  }
}

TEST(Edges, HingeOfTrianglesWoundAgainstEachOther) {
  const std::vector<Hinge> hinges = find_hinges(find_edges({{0, 1, 2}, {0, 1, 3}}, 4));
  ASSERT_EQ(hinges.size(), 1u);
  EXPECT_EQ(hinges[0].v0, 0);
  EXPECT_EQ(hinges[0].v2, 2);
  EXPECT_EQ(hinges[0].v3, 3);
  const Hinge backward = find_hinges(find_edges({{1, 0, 2}, {1, 0, 3}}, 4)).front();
  EXPECT_EQ(backward.v0, 1);
  EXPECT_EQ(backward.v2, 2);
}

TEST(Edges, IndexOutOfRangeIsNamed) {
  try {
    find_edges({{0, 1, 2}, {0, 7, 1}}, 3);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where().element, "triangle 1");
    EXPECT_NE(std::string(error.what()).find("vertex 7"), std::string::npos);
  }
  EXPECT_THROW(find_edges({{0, -1, 2}}, 3), Error);
  EXPECT_TRUE(find_edges({}, 0).empty());
}

TEST(Boundary, FourTrianglesRoundOneVertexMakeTwoLoopsWhereTheyTouch) {
  const std::vector<Edge> bow_tie = find_edges({{0, 1, 2}, {2, 3, 4}}, 5);
  const auto loops = boundary_loops(bow_tie, 5);
  ASSERT_EQ(loops.size(), 2u);
  for (const auto& loop : loops) EXPECT_EQ(std::set<int>(loop.begin(), loop.end()).size(), 3u);
}

TEST(Boundary, BandAndMoebiusBand) {
  const std::vector<Edge> straight = find_edges(band(6, false), 12), twisted = find_edges(band(6, true), 12);
  EXPECT_EQ(boundary_loops(straight, 12).size(), 2u);
  EXPECT_EQ(boundary_loops(twisted, 12).size(), 1u);
  EXPECT_TRUE(find_pieces(straight, 12).one_sided_edges.empty());
  EXPECT_EQ(find_pieces(twisted, 12).one_sided_edges.size(), 1u);
  EXPECT_FALSE(is_wound_consistently(twisted));
}

TEST(Boundary, FloodFillTurnsExactlyTheTrianglesThatWereTurned) {
  const TriangleMesh sphere = sphere_mesh(3);
  std::mt19937 random(3);
  for (int round = 0; round < 10; ++round) {
    std::vector<Triangle> triangles = sphere.triangles;
    std::set<int> turned;
    while (turned.size() < triangles.size() / 3) turned.insert(static_cast<int>(random() % triangles.size()));
    flip(triangles, {turned.begin(), turned.end()});
    const Pieces pieces =
        find_pieces(find_edges(triangles, count_of(sphere.positions)), static_cast<int>(triangles.size()));
    EXPECT_EQ(pieces.count, 1);
    EXPECT_EQ(std::set<int>(pieces.flipped.begin(), pieces.flipped.end()), turned);
    flip(triangles, pieces.flipped);
    EXPECT_TRUE(is_wound_consistently(find_edges(triangles, count_of(sphere.positions))));
  }
}

TEST(Boundary, PiecesAreCountedAndThreeTrianglesAtAnEdgeAreNoManifold) {
  EXPECT_EQ(find_pieces(find_edges({{0, 1, 2}, {3, 4, 5}, {2, 1, 6}}, 7), 3).of_triangle, (std::vector<int>{0, 1, 0}));
  const std::vector<Edge> fan = find_edges({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, 5);
  EXPECT_FALSE(is_edge_manifold(fan));
  EXPECT_TRUE(find_hinges(fan).empty());
  EXPECT_FALSE(is_closed(find_edges({}, 0)));
}

}  // namespace
}  // namespace pliant
