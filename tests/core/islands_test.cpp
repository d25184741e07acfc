// Tests the union of islands against a search by brute force.
#include "core/islands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace pliant {
namespace {

/// The smallest number that each number reaches by pairs: labels are lowered until nothing changes.
std::vector<int> by_brute_force(int size, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<int> label(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) label[static_cast<std::size_t>(i)] = i;
  for (bool changes = true; changes;) {
    changes = false;
    for (const auto& [a, b] : pairs) {
      int &one = label[static_cast<std::size_t>(a)], &other = label[static_cast<std::size_t>(b)];
      if (one == other) continue;
      one = other = std::min(one, other);
      changes = true;
    }
  }
  return label;
}

std::vector<int> found(int size, const std::vector<std::pair<int, int>>& pairs) {
  Islands islands;
  islands.reset(size);
  for (const auto& [a, b] : pairs) islands.unite(a, b);
  std::vector<int> out;
  out.reserve(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) out.push_back(islands.find(i));
  return out;
}

TEST(Islands, AreThoseOfASearchByBruteForce) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const int size = 1 + static_cast<int>(random() % 60), count = static_cast<int>(random() % 60);
    std::vector<std::pair<int, int>> pairs;
    pairs.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      pairs.emplace_back(static_cast<int>(random() % static_cast<unsigned>(size)),
                         static_cast<int>(random() % static_cast<unsigned>(size)));
    EXPECT_EQ(found(size, pairs), by_brute_force(size, pairs)) << "round " << round;
    std::vector<std::pair<int, int>> reversed;
    for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair) reversed.emplace_back(pair->second, pair->first);
    EXPECT_EQ(found(size, reversed), found(size, pairs)) << "the order of pairs does not matter, round " << round;
  }
}

TEST(Islands, ResetSeparatesAll) {
  Islands islands;
  islands.reset(3);
  islands.unite(2, 0);
  EXPECT_EQ(islands.find(2), 0);
  islands.reset(4);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(islands.find(i), i);
}

/// A quadratic search would need 10^12 visits here, which is hours on any machine.
TEST(Islands, ALongChainInAnyOrderIsOneIsland) {
  constexpr int size = 1000000;
  for (const bool ascends : {true, false}) {
    Islands islands;
    islands.reset(size);
    for (int i = 0; i + 1 < size; ++i) {
      const int a = ascends ? i : size - 2 - i;
      islands.unite(a, a + 1);
    }
    int others = 0;
    for (int i = 0; i < size; ++i) others += islands.find(i) != 0 ? 1 : 0;
    EXPECT_EQ(others, 0);
  }
}

}  // namespace
}  // namespace pliant
