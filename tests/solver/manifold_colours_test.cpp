// Tests the colours of manifolds: no colour has a dynamic body twice, every manifold occurs once, and order is kept.
#include "solver/bodies/manifold_colours.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace pliant {
namespace {

using PairsOfBodies = std::vector<std::pair<int, int>>;

/// Pairs of different bodies, sorted, each at most once. Body 0 occurs in `of_first` of them.
PairsOfBodies random_pairs(int bodies, int count, int of_first, std::mt19937& random) {
  std::set<std::pair<int, int>> pairs;
  for (int i = 0; i < of_first; ++i) pairs.insert({0, 1 + i});
  while (static_cast<int>(pairs.size()) < count) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(bodies)),
              b = static_cast<int>(random() % static_cast<unsigned>(bodies));
    if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
  }
  return {pairs.begin(), pairs.end()};
}

/// Every manifold is there once, colours share no dynamic body, and each range ascends.
void expect_valid(const ManifoldColours& colours, const PairsOfBodies& pairs, const std::vector<char>& is_fixed) {
  const std::vector<int>&order = colours.order(), &start = colours.start();
  ASSERT_EQ(start.size(), std::size_t(manifold_colours + 2));
  EXPECT_EQ(start.front(), 0);
  EXPECT_EQ(start.back(), int(pairs.size()));
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), pairs.size());
  for (std::size_t c = 0; c + 1 < start.size(); ++c) {
    std::set<int> seen;
    for (int i = start[c]; i < start[c + 1]; ++i) {
      if (i > start[c]) {
        EXPECT_LT(order[std::size_t(i - 1)], order[std::size_t(i)]);
      }
      const auto [a, b] = pairs[std::size_t(order[std::size_t(i)])];
      for (const int body : {a, b})
        if (c < manifold_colours && is_fixed[std::size_t(body)] == 0) {
          EXPECT_TRUE(seen.insert(body).second) << "body " << body << ", colour " << c;
        }
    }
  }
}

TEST(ManifoldColours, NoColourHasADynamicBodyTwice) {
  std::mt19937 random(1);
  ManifoldColours colours;  // reused, so that nothing may remain of an earlier call
  for (const int bodies : {2, 40, 400, 40})
    for (const int fixed : {0, 7}) {
      const PairsOfBodies pairs = random_pairs(bodies, bodies == 2 ? 1 : 4 * bodies, 0, random);
      std::vector<char> is_fixed(std::size_t(bodies), 0);
      for (int i = 0; i < bodies && fixed != 0; i += fixed) is_fixed[std::size_t(i)] = 1;
      colours.colour(pairs, is_fixed);
      expect_valid(colours, pairs, is_fixed);
      EXPECT_EQ(colours.tail(), int(pairs.size())) << "a pile needs no tail";
    }
}

TEST(ManifoldColours, WhatADynamicSlabCarriesIsTheTail) {
  std::mt19937 random(2);
  const PairsOfBodies pairs = random_pairs(101, 100, 100, random);
  ManifoldColours colours;
  std::vector<char> is_fixed(101, 0);
  colours.colour(pairs, is_fixed);
  expect_valid(colours, pairs, is_fixed);
  EXPECT_EQ(colours.tail(), manifold_colours);
  is_fixed[0] = 1;
  colours.colour(pairs, is_fixed);
  expect_valid(colours, pairs, is_fixed);
  EXPECT_EQ(colours.start()[1], 100) << "a fixed slab limits nothing: one colour";
}

/// A chain of bodies in order needs two colours; known by hand.
TEST(ManifoldColours, AChainHasTwoColours) {
  const PairsOfBodies pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}};
  ManifoldColours colours;
  colours.colour(pairs, std::vector<char>(6, 0));
  EXPECT_EQ(colours.order(), (std::vector<int>{0, 2, 4, 1, 3}));
  EXPECT_EQ(colours.start()[1], 3);
  EXPECT_EQ(colours.start()[2], 5);
}

TEST(ManifoldColours, NothingHasNoColour) {
  ManifoldColours colours;
  EXPECT_EQ(colours.tail(), 0) << "before the first call";
  colours.colour({}, {});
  EXPECT_TRUE(colours.order().empty());
  EXPECT_EQ(colours.start().back(), 0);
}

}  // namespace
}  // namespace pliant
