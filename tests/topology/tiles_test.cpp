// Tests tiles: every particle is in one, and none is too large, whatever the positions.
#include "topology/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pliant {
namespace {

std::vector<Vec3f> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3f> points(static_cast<std::size_t>(count));
  const auto coordinate = [&] { return static_cast<float>(random()) / 4294967296.f; };
  for (Vec3f& p : points) p = {coordinate(), 3 * coordinate(), coordinate() - 0.5f};
  return points;
}

/// The number of particles in each tile. Fails if a tile number is skipped.
std::vector<int> sizes_of(const std::vector<int>& tile) {
  std::vector<int> sizes;
  for (int t : tile) {
    EXPECT_GE(t, 0);
    if (t >= static_cast<int>(sizes.size())) sizes.resize(static_cast<std::size_t>(t) + 1, 0);
    ++sizes[static_cast<std::size_t>(t)];
  }
  EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0), 0) << "an empty tile";
  return sizes;
}

TEST(Tiles, HoldEveryParticleOnceAndAreNotTooLarge) {
  for (int count : {1, 2, 3, 7, 16, 17, 63, 100, 1000, 1023, 1025}) {
    for (int largest : {1, 2, 5, 16, 64, 4096}) {
      const std::vector<int> tile = cut_into_tiles(random_points(count, 5), largest);
      ASSERT_EQ(tile.size(), static_cast<std::size_t>(count));
      const std::vector<int> sizes = sizes_of(tile);
      EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), largest) << count << " points in tiles of " << largest;
      // Bisection by number: all sizes are equal, up to one.
      EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()) - *std::min_element(sizes.begin(), sizes.end()), 1);
    }
  }
}

TEST(Tiles, NoneForNothing) { EXPECT_TRUE(cut_into_tiles({}, 16).empty()); }

TEST(Tiles, CutAPileOfCoincidentPoints) {
  const std::vector<int> tile = cut_into_tiles(std::vector<Vec3f>(100, Vec3f{1, 1, 1}), 10);
  const std::vector<int> sizes = sizes_of(tile);
  EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 10);
  EXPECT_TRUE(std::is_sorted(tile.begin(), tile.end())) << "ties go by index";
}

TEST(Tiles, AreCutAcrossTheLongestSide) {
  std::vector<Vec3f> line;
  for (int i = 0; i < 64; ++i) line.push_back({0, 0, static_cast<float>(i)});
  const std::vector<int> tile = cut_into_tiles(line, 16);
  for (int i = 0; i < 64; ++i) EXPECT_EQ(tile[static_cast<std::size_t>(i)], i / 16);
}

TEST(Tiles, DependOnThePositionsAlone) {
  const std::vector<Vec3f> points = random_points(5000, 8);
  EXPECT_EQ(cut_into_tiles(points, 100), cut_into_tiles(points, 100));
}

}  // namespace
}  // namespace pliant
