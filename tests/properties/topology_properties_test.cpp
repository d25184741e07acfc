// Tests what numbering, colouring and tiling guarantee for any mesh.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "generators.h"
#include "topology/colouring.h"
#include "topology/edges.h"
#include "topology/lockstep.h"
#include "topology/tiles.h"

namespace pliant::properties {
namespace {

bool is_permutation(std::vector<int> order, int count) {
  std::sort(order.begin(), order.end());
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  return order == all;
}

RC_GTEST_PROP(Colouring, TakesEachConstraintOnceAndNoParticleTwiceInAColour, ()) {
  const int particles = *rc::gen::inRange(8, 200), size = *rc::gen::inRange(2, 9), count = *rc::gen::inRange(0, 120);
  const std::vector<int> stencils = properties::stencils(count, size, particles);
  std::vector<int> members(static_cast<std::size_t>(count));
  std::iota(members.begin(), members.end(), 0);
  std::vector<int> found;
  for (const Colour& colour : Colouring(particles).colour(stencils, size, members)) {
    std::set<int> used;
    for (const int member : colour.members) {
      found.push_back(member);
      for (int slot = 0; slot < size; ++slot) RC_ASSERT(used.insert(stencils[size * member + slot]).second);
    }
  }
  RC_ASSERT(is_permutation(found, count));
}

RC_GTEST_PROP(Tiles, HoldNoMoreThanAllowedAndEachParticleOnce, ()) {
  const int count = *rc::gen::inRange(1, 300), largest = *rc::gen::inRange(1, 50);
  std::vector<Vec3f> positions;
  for (int i = 0; i < count; ++i) positions.push_back(point(1));
  std::map<int, int> sizes;
  for (const int tile : cut_into_tiles(positions, largest)) ++sizes[tile];
  int expected = 0;
  for (const auto& [tile, size] : sizes) {
    RC_ASSERT(tile == expected++);
    RC_ASSERT(size <= largest);
  }
}

RC_GTEST_PROP(Lockstep, IsAPermutationThatKeepsTilesTogether, ()) {
  const int count = *rc::gen::inRange(1, 200);
  std::vector<Vec3f> positions;
  for (int i = 0; i < count; ++i) positions.push_back(point(1));
  const std::vector<int> tile = cut_into_tiles(positions, 40);
  std::vector<std::array<int, 2>> links;
  if (count > 1)
    for (int i = *rc::gen::inRange(0, 300); i > 0; --i) {
      const int a = *rc::gen::inRange(0, count), b = *rc::gen::inRange(1, count);
      links.push_back({a, (a + b) % count});
    }
  const std::vector<int> order = number_in_lockstep(positions, tile, links);
  RC_ASSERT(is_permutation(order, count));
  for (std::size_t i = 1; i < order.size(); ++i) RC_ASSERT(tile[order[i - 1]] <= tile[order[i]]);
}

RC_GTEST_PROP(Edges, CountEachSideOfEachTriangle, ()) {
  const int vertices = *rc::gen::inRange(3, 30);
  const TriangleMesh mesh = soup(vertices, *rc::gen::inRange(0, 60), 1);
  std::map<std::pair<int, int>, int> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[std::minmax(t[k], t[(k + 1) % 3])];
  const std::vector<Edge> edges = find_edges(mesh.triangles, vertices);
  RC_ASSERT(edges.size() == sides.size());
  for (const Edge& edge : edges) RC_ASSERT(edge.triangle_count == sides.at({edge.a, edge.b}));
}

}  // namespace
}  // namespace pliant::properties
