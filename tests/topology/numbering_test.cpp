// Tests the storage order: a permutation, tile after tile, in each line of linked particles the even ones first.
#include "topology/numbering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pliant {
namespace {

bool is_permutation_of_all(std::vector<int> order) {
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] != static_cast<int>(i)) return false;
  }
  return true;
}

TEST(Numbering, IsAPermutationInTileOrder) {
  std::mt19937 random(1);
  for (int count : {0, 1, 2, 3, 4, 5, 50, 999}) {
    std::vector<int> tile(static_cast<std::size_t>(count));
    std::vector<char> linked(tile.size());
    for (int& t : tile) t = static_cast<int>(random() % 7);
    for (char& l : linked) l = static_cast<char>(random() % 2);
    const std::vector<int> order = number_in_chains(tile, linked);
    ASSERT_EQ(order.size(), tile.size());
    EXPECT_TRUE(is_permutation_of_all(order));
    for (std::size_t i = 1; i < order.size(); ++i) {
      EXPECT_LE(tile[static_cast<std::size_t>(order[i - 1])], tile[static_cast<std::size_t>(order[i])]);
    }
  }
}

TEST(Numbering, StoresALineEvensFirst) {
  const std::vector<int> tile(7, 0);
  EXPECT_EQ(number_in_chains(tile, {1, 1, 1, 1, 1, 1, 0}), (std::vector<int>{0, 2, 4, 6, 1, 3, 5}));
}

TEST(Numbering, CutsLinesWhereTheLinkIsMissing) {
  const std::vector<int> tile(7, 0);
  EXPECT_EQ(number_in_chains(tile, {1, 1, 0, 1, 1, 1, 0}), (std::vector<int>{0, 2, 1, 3, 5, 4, 6}));
}

TEST(Numbering, CutsLinesWhereTheTileChanges) {
  EXPECT_EQ(number_in_chains({0, 0, 0, 1, 1, 1}, {1, 1, 1, 1, 1, 0}), (std::vector<int>{0, 2, 1, 3, 5, 4}));
  // A line that leaves its tile and returns is two lines.
  EXPECT_EQ(number_in_chains({0, 0, 1, 0, 0, 0}, {1, 1, 1, 1, 1, 0}), (std::vector<int>{0, 1, 3, 5, 4, 2}));
}

TEST(Numbering, LeavesWhatHasNoLinksInItsOrder) {
  EXPECT_EQ(number_in_chains({0, 0, 0, 0}, {0, 0, 0, 0}), (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace pliant
