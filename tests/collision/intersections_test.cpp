// Compares intersections found by the BVH with tests of all pairs, and with surfaces whose intersections are known.
#include "collision/untangle/intersections.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "support/nasty.h"

namespace pliant {
namespace {

std::vector<Intersection> brute(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Intersection> found;
  for (const Edge& edge : find_edges(triangles, static_cast<int>(positions.size())))
    for (int i = 0; i < static_cast<int>(triangles.size()); ++i) {
      const Triangle& t = triangles[static_cast<std::size_t>(i)];
      if (std::count(t.begin(), t.end(), edge.a) + std::count(t.begin(), t.end(), edge.b) > 0) continue;
      const auto at = [&](int v) { return positions[static_cast<std::size_t>(v)]; };
      const auto kind = how_edge_meets_triangle({at(edge.a), at(edge.b)}, {at(t[0]), at(t[1]), at(t[2])});
      if (kind != EdgeTriangle::apart) found.push_back({edge.a, edge.b, i, kind});
    }
  return found;
}

TEST(Intersections, AreThoseOfAllPairs) {
  std::mt19937_64 random(51);
  std::size_t crossings = 0, touches = 0;
  for (int i = 0; i < 900; ++i) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    for (const auto& corners : testing_support::nasty_triangles(random, i % testing_support::nasty_kinds)) {
      const int first = static_cast<int>(positions.size());
      positions.insert(positions.end(), corners.begin(), corners.end());
      triangles.push_back({first, first + 1, first + 2});
      if (first > 0 && i % 2 == 0) triangles.push_back({first, first - 1, first + 1});  // pairs that share vertices
    }
    const int vertices = static_cast<int>(positions.size());
    IntersectionFinder finder(triangles, vertices);
    auto expected = brute(positions, triangles);
    ASSERT_EQ(finder.find(positions, true), expected) << i;
    touches += expected.size();
    const auto touching = [](const Intersection& x) { return x.kind == EdgeTriangle::touching; };
    expected.erase(std::remove_if(expected.begin(), expected.end(), touching), expected.end());
    ASSERT_EQ(finder.find(positions), expected) << i;
    crossings += expected.size();
  }
  EXPECT_GT(crossings, 1000u);
  EXPECT_GT(touches, crossings + 1000);
}

TEST(Intersections, KnowACleanSheetAndOneFoldedThroughItself) {
  TriangleMesh sheet = grid_mesh(20, 20, 1, 1);
  IntersectionFinder finder(sheet.triangles, 400);
  EXPECT_TRUE(finder.find(sheet.positions, true).empty());
  for (std::size_t r = 10; r < 20; ++r)  // the far half is folded back and down through the near half
    for (std::size_t c = 0; c < 20; ++c) {
      Vec3f& p = sheet.positions[r * 20 + c];
      p = {p.x + 0.013f, 0.1f - 0.4f * p.z, -p.z * 0.9f - 0.011f};
    }
  EXPECT_GE(finder.find(sheet.positions).size(), 19u);
  EXPECT_THROW(IntersectionFinder({{0, 1, 7}}, 3), Error);
}

}  // namespace
}  // namespace pliant
