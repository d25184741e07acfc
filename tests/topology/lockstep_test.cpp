// Tests the lockstep order: a permutation in any case, complete runs if four patches are equal, many runs on a mesh
// without lines.
#include "topology/lockstep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "topology/colouring.h"

namespace pliant {
namespace {

using Links = std::vector<std::array<int, 2>>;

struct Mesh {
  std::vector<Vec3f> positions;
  Links links;
};

/// A grid of n x n whose points are displaced by up to 0.3 of a cell, with random diagonals, so that it has no lines.
Mesh irregular_mesh(int n, unsigned seed) {
  std::mt19937 random(seed);
  const auto stray = [&] { return 0.6f * (static_cast<float>(random() % 1000) / 1000 - 0.5f); };
  Mesh mesh;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c)
      mesh.positions.push_back({static_cast<float>(c) + stray(), static_cast<float>(r) + stray(), 0});
  }
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const int a = r * n + c;
      if (c + 1 < n) mesh.links.push_back({a, a + 1});
      if (r + 1 < n) mesh.links.push_back({a, a + n});
      if (r + 1 == n || c + 1 == n) continue;
      mesh.links.push_back(random() % 2 == 0 ? std::array<int, 2>{a, a + n + 1} : std::array<int, 2>{a + 1, a + n});
    }
  }
  return mesh;
}

/// The same mesh with vertices renumbered randomly.
Mesh shuffled(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> name(mesh.positions.size());
  std::iota(name.begin(), name.end(), 0);
  std::shuffle(name.begin(), name.end(), random);
  Mesh out = mesh;
  for (std::size_t i = 0; i < name.size(); ++i) out.positions[static_cast<std::size_t>(name[i])] = mesh.positions[i];
  for (auto& link : out.links)
    link = {name[static_cast<std::size_t>(link[0])], name[static_cast<std::size_t>(link[1])]};
  return out;
}

/// Four copies of a mesh, far apart.
Mesh four_times(const Mesh& mesh) {
  Mesh out;
  const int n = static_cast<int>(mesh.positions.size());
  for (int copy = 0; copy < 4; ++copy) {
    const Vec3f shift{1000.f * static_cast<float>(copy), 0, 0};
    for (const Vec3f& p : mesh.positions) out.positions.push_back(p + shift);
    for (const auto& [a, b] : mesh.links) out.links.push_back({a + copy * n, b + copy * n});
  }
  return out;
}

std::vector<int> places(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  return place;
}

double share_of_links_in_runs(const Mesh& mesh, const std::vector<int>& order) {
  const std::vector<int> place = places(order);
  std::vector<int> stencils;
  for (const auto& [a, b] : mesh.links) {
    const int i = place[static_cast<std::size_t>(a)], j = place[static_cast<std::size_t>(b)];
    stencils.insert(stencils.end(), {std::min(i, j), std::max(i, j)});
  }
  return share_in_runs(stencils, 2);
}

void expect_permutation_in_tile_order(const std::vector<int>& order, const std::vector<int>& tile) {
  std::vector<int> sorted = order, all(tile.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_LE(tile[static_cast<std::size_t>(order[i - 1])], tile[static_cast<std::size_t>(order[i])]);
}

TEST(Lockstep, IsAPermutationInTileOrder) {
  std::mt19937 random(1);
  for (int count : {0, 1, 2, 3, 4, 5, 7, 8, 50, 999}) {
    for (int tiles : {1, 3}) {
      std::vector<Vec3f> positions;
      std::vector<int> tile;
      Links links;
      const auto number = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
      for (int i = 0; i < count; ++i) {
        positions.push_back({static_cast<float>(number(100)), static_cast<float>(number(100)), 0});
        tile.push_back(std::min(tiles - 1, number(5)));
        for (int k = 0; k < 3; ++k) links.push_back({i, number(count)});  // some to itself, some twice
      }
      expect_permutation_in_tile_order(number_in_lockstep(positions, tile, links), tile);
    }
  }
}

TEST(Lockstep, PutsAllLinksOfFourEqualPatchesInRuns) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Mesh mesh = four_times(shuffled(irregular_mesh(12, seed), seed));
    const std::vector<int> tile(mesh.positions.size(), 0);
    EXPECT_EQ(share_of_links_in_runs(mesh, number_in_lockstep(mesh.positions, tile, mesh.links)), 1);
  }
}

TEST(Lockstep, PutsManyLinksOfAnIrregularMeshInRuns) {
  const Mesh mesh = shuffled(irregular_mesh(40, 2), 3);
  const std::vector<int> tile(mesh.positions.size(), 0);
  std::vector<int> as_given(tile.size());
  std::iota(as_given.begin(), as_given.end(), 0);
  EXPECT_LT(share_of_links_in_runs(mesh, as_given), 0.01);
  EXPECT_GT(share_of_links_in_runs(mesh, number_in_lockstep(mesh.positions, tile, mesh.links)), 0.45);
}

TEST(Lockstep, BeginsFoursAtMultiplesOfFour) {
  // Tiles of odd sizes: those after the first must also begin at a multiple of four.
  const Mesh mesh = shuffled(irregular_mesh(30, 4), 5);
  std::vector<int> tile(mesh.positions.size());
  for (std::size_t i = 0; i < tile.size(); ++i)
    tile[i] = mesh.positions[i].x < 9.4f ? 0 : mesh.positions[i].x < 20.3f ? 1 : 2;
  const std::vector<int> order = number_in_lockstep(mesh.positions, tile, mesh.links), place = places(order);
  expect_permutation_in_tile_order(order, tile);
  std::vector<std::array<int, 2>> seen;
  for (const auto& [a, b] : mesh.links)
    seen.push_back({std::min(place[static_cast<std::size_t>(a)], place[static_cast<std::size_t>(b)]),
                    std::max(place[static_cast<std::size_t>(a)], place[static_cast<std::size_t>(b)])});
  std::sort(seen.begin(), seen.end());
  const auto has = [&](int i, int j) { return std::binary_search(seen.begin(), seen.end(), std::array<int, 2>{i, j}); };
  double aligned = 0;
  for (const auto& [i, j] : seen) {
    if (i % 4 == 0 && j % 4 == 0 && has(i + 1, j + 1) && has(i + 2, j + 2) && has(i + 3, j + 3)) aligned += 4;
  }
  EXPECT_GT(aligned / static_cast<double>(seen.size()), 0.95 * share_of_links_in_runs(mesh, order));
}

TEST(Lockstep, OfHubs) {
  Mesh hubs;
  for (int hub = 0; hub < 4; ++hub) {
    const int centre = static_cast<int>(hubs.positions.size());
    hubs.positions.push_back({100.f * static_cast<float>(hub), 0, 0});
    for (int i = 1; i <= 20000; ++i) {
      hubs.positions.push_back({100.f * static_cast<float>(hub) + 1, static_cast<float>(i) * 1e-4f, 0});
      hubs.links.push_back({centre, centre + i});
    }
  }
  const std::vector<int> tile(hubs.positions.size(), 0);
  const std::vector<int> order = number_in_lockstep(hubs.positions, tile, hubs.links);
  expect_permutation_in_tile_order(order, tile);
  EXPECT_EQ(share_of_links_in_runs(hubs, order), 1);
}

TEST(Lockstep, DoesNotDependOnTheOrderOfLinks) {
  Mesh mesh = shuffled(irregular_mesh(20, 6), 7);
  const std::vector<int> tile(mesh.positions.size(), 0), order = number_in_lockstep(mesh.positions, tile, mesh.links);
  std::mt19937 random(8);
  std::shuffle(mesh.links.begin(), mesh.links.end(), random);
  for (auto& link : mesh.links) std::swap(link[0], link[1]);
  mesh.links.insert(mesh.links.end(), mesh.links.begin(), mesh.links.begin() + 100);
  EXPECT_EQ(number_in_lockstep(mesh.positions, tile, mesh.links), order);
}

}  // namespace
}  // namespace pliant
