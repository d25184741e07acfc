// Tests groups of four: they have the contiguous slots that they claim, no constraint is in two, and those with most
// contiguous slots are found first.
#include "topology/fours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace pliant {
namespace {

/// Checks the groups taken from all constraints of `stencils`, and that no constraint was lost.
std::vector<Four> checked_fours(const std::vector<int>& stencils, int size) {
  std::vector<int> members(stencils.size() / static_cast<std::size_t>(size));
  std::iota(members.begin(), members.end(), 0);
  const std::size_t all = members.size();
  const std::vector<Four> fours = take_fours(stencils, size, members);
  EXPECT_EQ(4 * fours.size() + members.size(), all);
  EXPECT_TRUE(std::is_sorted(members.begin(), members.end())) << "what is left keeps its order";
  std::set<int> met(members.begin(), members.end());
  const auto at = [&](int member, int slot) { return stencils[static_cast<std::size_t>(size * member + slot)]; };
  for (const Four& four : fours) {
    EXPECT_GT(four.runs, 0);
    EXPECT_LT(four.runs, 1 << size);
    std::set<int> particles;
    for (int l = 0; l < 4; ++l) {
      const int member = four.members[static_cast<std::size_t>(l)];
      EXPECT_TRUE(met.insert(member).second) << member << " twice";
      for (int slot = 0; slot < size; ++slot) {
        EXPECT_TRUE(particles.insert(at(member, slot)).second) << "a particle shared";
        if ((four.runs >> slot & 1) == 0) continue;
        EXPECT_EQ(at(member, slot), at(four.members[0], slot) + l);
      }
    }
    int first = 0;
    while ((four.runs >> first & 1) == 0) ++first;
    EXPECT_EQ(at(four.members[0], first) % 4, 0);
  }
  return fours;
}

/// `count` constraints. Slots whose bit is set in `runs` are contiguous from a multiple of four on; other slots have
/// random multiples of four, which no group can have.
std::vector<int> stencils_with(int runs, int size, int count, std::mt19937& random) {
  std::vector<int> others(static_cast<std::size_t>(size * count));
  for (std::size_t i = 0; i < others.size(); ++i) others[i] = size * count + 4 * static_cast<int>(i);
  std::shuffle(others.begin(), others.end(), random);
  std::vector<int> stencils;
  for (int i = 0; i < count; ++i) {
    for (int slot = 0; slot < size; ++slot) {
      stencils.push_back((runs >> slot & 1) != 0 ? slot * count + i : others[stencils.size()]);
    }
  }
  return stencils;
}

TEST(Fours, FindsEverySetOfSlots) {
  std::mt19937 random(1);
  for (int size = 1; size <= 4; ++size) {
    for (int runs = 1; runs < 1 << size; ++runs) {
      const std::vector<Four> fours = checked_fours(stencils_with(runs, size, 400, random), size);
      const auto as_made =
          std::count_if(fours.begin(), fours.end(), [&](const Four& f) { return (f.runs & runs) == runs; });
      EXPECT_GE(as_made, 98) << "slots " << runs << " of " << size;  // one may by chance match random ones
    }
  }
}

TEST(Fours, OfRandomStencils) {
  std::mt19937 random(2);
  for (int size = 1; size <= 4; ++size) {
    for (int particles : {8, 40, 400}) {
      std::vector<int> stencils;
      for (int i = 0; i < 500; ++i) {
        std::set<int> stencil;
        while (static_cast<int>(stencil.size()) < size)
          stencil.insert(static_cast<int>(random() % static_cast<unsigned>(particles)));
        stencils.insert(stencils.end(), stencil.begin(), stencil.end());
      }
      checked_fours(stencils, size);
    }
  }
}

TEST(Fours, NoneOfNothingAndNoneOfAHub) {
  EXPECT_TRUE(checked_fours({}, 2).empty());
  std::vector<int> star;
  for (int i = 1; i <= 3000; ++i) star.insert(star.end(), {0, 4 * i});
  EXPECT_TRUE(checked_fours(star, 2).empty()) << "all are in the same lane";
  star.clear();
  for (int i = 1; i <= 3000; ++i) star.insert(star.end(), {0, i});
  EXPECT_TRUE(checked_fours(star, 2).empty()) << "any two share the hub";
}

TEST(Fours, TakesSeveralOfOnePlace) {
  // Particles 0..3, each with three constraints to random others: three groups, contiguous in slot 0.
  std::vector<int> stencils;
  for (int i = 0; i < 12; ++i) stencils.insert(stencils.end(), {i % 4, 100 + 7 * i});
  const std::vector<Four> fours = checked_fours(stencils, 2);
  ASSERT_EQ(fours.size(), 3u);
  for (const Four& four : fours) EXPECT_EQ(four.runs, 1);
}

}  // namespace
}  // namespace pliant
