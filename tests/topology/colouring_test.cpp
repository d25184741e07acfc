// Tests colours: every constraint is in exactly one, no particle occurs twice in one, and runs are contiguous; on
// random stencils and on stars.
#include "topology/colouring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace pliant {
namespace {

struct Constraints {
  int particles = 0, size = 0;
  std::vector<int> stencils;
  int count() const { return static_cast<int>(stencils.size()) / size; }
  int at(int constraint, int slot) const { return stencils[static_cast<std::size_t>(constraint * size + slot)]; }
};

std::vector<int> all_of(const Constraints& c) {
  std::vector<int> members(static_cast<std::size_t>(c.count()));
  std::iota(members.begin(), members.end(), 0);
  return members;
}

void expect_independent(const Constraints& c, const Colour& colour) {
  std::set<int> met;
  for (int member : colour.members) {
    for (int slot = 0; slot < c.size; ++slot) {
      EXPECT_TRUE(met.insert(c.at(member, slot)).second) << "particle " << c.at(member, slot) << " twice in a colour";
    }
  }
}

void expect_runs(const Constraints& c, const Colour& colour) {
  ASSERT_EQ(colour.members.size() % (colour.runs + 1 == 1 << c.size ? 4 : 16), 0u)
      << "only whole runs come in less than batches";
  for (std::size_t first = 0; first < colour.members.size(); first += 4) {
    for (int l = 1; l < 4; ++l) {
      for (int slot = 0; slot < c.size; ++slot) {
        if ((colour.runs >> slot & 1) == 0) continue;
        EXPECT_EQ(c.at(colour.members[first + static_cast<std::size_t>(l)], slot),
                  c.at(colour.members[first], slot) + l);
      }
    }
  }
}

/// Colours constraints, and checks everything on which a schedule relies.
std::vector<Colour> checked_colours(const Constraints& c, const std::vector<int>& members) {
  Colouring colouring(c.particles);
  const std::vector<Colour> colours = colouring.colour(c.stencils, c.size, members);
  std::vector<int> found;
  for (const Colour& colour : colours) {
    EXPECT_FALSE(colour.members.empty());
    expect_independent(c, colour);
    if (colour.runs != 0) expect_runs(c, colour);
    found.insert(found.end(), colour.members.begin(), colour.members.end());
  }
  std::vector<int> wanted = members;
  std::sort(wanted.begin(), wanted.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, wanted) << "every constraint once";
  return colours;
}

Constraints random_constraints(int particles, int size, int count, unsigned seed) {
  std::mt19937 random(seed);
  Constraints c{particles, size, {}};
  for (int i = 0; i < count; ++i) {
    std::vector<int> stencil;
    while (static_cast<int>(stencil.size()) < size) {
      const int p = static_cast<int>(random() % static_cast<unsigned>(particles));
      if (std::find(stencil.begin(), stencil.end(), p) == stencil.end()) stencil.push_back(p);
    }
    c.stencils.insert(c.stencils.end(), stencil.begin(), stencil.end());
  }
  return c;
}

TEST(Colouring, OfRandomStencilsOfEverySize) {
  for (int size = 1; size <= 4; ++size) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Constraints c = random_constraints(4 + static_cast<int>(seed) * 20, size, 300, seed);
      checked_colours(c, all_of(c));
    }
  }
}

TEST(Colouring, OfAPartLeavesTheRestAlone) {
  const Constraints c = random_constraints(40, 2, 200, 3);
  std::vector<int> some;
  for (int i = 0; i < 200; i += 3) some.push_back(i);
  checked_colours(c, some);
  EXPECT_TRUE(checked_colours(c, {}).empty());
}

/// Adds constraints to colours a few at a time, and checks that those that are there stay.
std::vector<Colour> extended(const Constraints& c, int at_once) {
  Colouring colouring(c.particles);
  std::vector<Colour> colours;
  for (int first = 0; first < c.count(); first += at_once) {
    std::vector<int> some;
    for (int i = first; i < std::min(first + at_once, c.count()); ++i) some.push_back(i);
    const std::vector<Colour> before = colours;
    colouring.extend(c.stencils, c.size, some, colours);
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_TRUE(std::equal(before[i].members.begin(), before[i].members.end(), colours[i].members.begin()));
  }
  std::vector<int> found;
  for (const Colour& colour : colours) {
    EXPECT_EQ(colour.runs, 0);
    expect_independent(c, colour);
    found.insert(found.end(), colour.members.begin(), colour.members.end());
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, all_of(c));
  return colours;
}

TEST(Colouring, IsExtended) {
  for (int size = 1; size <= 4; ++size)
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Constraints c = random_constraints(4 + static_cast<int>(seed) * 20, size, 300, seed);
      EXPECT_EQ(extended(c, 7).size(), extended(c, 300).size()) << "first fit";
    }
  Constraints star{501, 2, {}};
  for (int i = 1; i <= 500; ++i) star.stencils.insert(star.stencils.end(), {0, i});
  EXPECT_EQ(extended(star, 11).size(), 500u);
}

TEST(Colouring, OfAStarNeedsAColourAnEdge) {
  Constraints star{501, 2, {}};
  for (int i = 1; i <= 500; ++i) star.stencils.insert(star.stencils.end(), {0, i});
  EXPECT_EQ(checked_colours(star, all_of(star)).size(), 500u);
}

TEST(Colouring, OfManyStarsThatShareTips) {
  Constraints stars{300, 2, {}};
  for (int centre = 0; centre < 5; ++centre) {
    for (int i = 5; i < 300; ++i) stars.stencils.insert(stars.stencils.end(), {centre, i});
  }
  EXPECT_LT(checked_colours(stars, all_of(stars)).size(), 2 * 300u);  // 295 colours would be enough
}

TEST(Colouring, OfTheSameConstraintOverAndOver) {
  Constraints same{8, 4, {}};
  for (int i = 0; i < 150; ++i) same.stencils.insert(same.stencils.end(), {0, 3, 5, 7});
  EXPECT_EQ(checked_colours(same, all_of(same)).size(), 150u);
}

TEST(Colouring, FindsTheRunsOfALadder) {
  // Particles 0..63 joined to 64..127 one by one: sixteen runs of four, all in one colour.
  Constraints ladder{128, 2, {}};
  for (int i = 0; i < 64; ++i) ladder.stencils.insert(ladder.stencils.end(), {i, 64 + i});
  const std::vector<Colour> colours = checked_colours(ladder, all_of(ladder));
  ASSERT_EQ(colours.size(), 1u);
  EXPECT_EQ(colours[0].runs, 3);
}

TEST(Colouring, NeverTakesAChainForARun) {
  // (0,1), (1,2), (2,3), (3,4) are contiguous, but share particles.
  Constraints chain{40, 2, {}};
  for (int i = 0; i < 39; ++i) chain.stencils.insert(chain.stencils.end(), {i, i + 1});
  for (const Colour& colour : checked_colours(chain, all_of(chain))) EXPECT_NE(colour.runs, 3);
  Constraints skipping{40, 2, {}};
  for (int i = 0; i < 37; ++i) skipping.stencils.insert(skipping.stencils.end(), {i, i + 3});
  for (const Colour& colour : checked_colours(skipping, all_of(skipping))) EXPECT_NE(colour.runs, 3);
}

TEST(Colouring, GroupsWhatIsInRunsWithSomeSlotsAlone) {
  // Particles 0..2047 joined to random others: no constraint is contiguous in both slots, nearly all can be in the
  // first.
  std::mt19937 random(6);
  std::vector<int> strangers(2048);
  std::iota(strangers.begin(), strangers.end(), 2048);
  std::shuffle(strangers.begin(), strangers.end(), random);
  Constraints joined{4096, 2, {}};
  for (int i = 0; i < 2048; ++i)
    joined.stencils.insert(joined.stencils.end(), {i, strangers[static_cast<std::size_t>(i)]});
  std::size_t in_runs = 0;
  for (const Colour& colour : checked_colours(joined, all_of(joined)))
    in_runs += colour.runs != 0 ? colour.members.size() : 0;
  EXPECT_GE(in_runs, 1900u);
}

TEST(Colouring, LeavesALittleThatIsLeftAlone) {
  // A ladder of 64 rungs, and 16 constraints that could be contiguous in one slot: too few to fill batches of their
  // own.
  std::mt19937 random(7);
  std::vector<int> strangers(16);
  std::iota(strangers.begin(), strangers.end(), 200);
  std::shuffle(strangers.begin(), strangers.end(), random);
  Constraints ladder{300, 2, {}};
  for (int i = 0; i < 64; ++i) ladder.stencils.insert(ladder.stencils.end(), {i, 64 + i});
  for (int i = 0; i < 16; ++i)
    ladder.stencils.insert(ladder.stencils.end(), {i, strangers[static_cast<std::size_t>(i)]});
  for (const Colour& colour : checked_colours(ladder, all_of(ladder)))
    EXPECT_TRUE(colour.runs == 0 || colour.runs == 3);
}

TEST(Colouring, ShareInRuns) {
  EXPECT_EQ(share_in_runs({}, 2), 1);
  EXPECT_EQ(share_in_runs({0, 10, 1, 11, 2, 12, 3, 13}, 2), 1);
  EXPECT_EQ(share_in_runs({0, 10, 1, 11, 2, 12, 3, 14}, 2), 0);
  EXPECT_EQ(share_in_runs({3, 13, 1, 11, 2, 12, 0, 10, 5, 9}, 2), 0.8);
}

TEST(Colouring, OfRunsOfEverySizeAndShape) {
  std::mt19937 random(4);
  for (int size = 1; size <= 4; ++size) {
    Constraints c{2000, size, {}};
    for (int family = 0; family < 12; ++family) {
      std::vector<int> shape{0};
      while (static_cast<int>(shape.size()) < size) {
        const int offset = static_cast<int>(random() % 13);
        if (std::find(shape.begin(), shape.end(), offset) == shape.end()) shape.push_back(offset);
      }
      for (int i = 0; i < 100; ++i) {
        for (int offset : shape) c.stencils.push_back(100 * family + i + offset);
      }
    }
    checked_colours(c, all_of(c));
  }
}

TEST(Colouring, IsTheSameEachTimeAndAfterOthers) {
  const Constraints a = random_constraints(60, 2, 400, 1), b = random_constraints(60, 2, 100, 2);
  Colouring fresh(60), used(60);
  used.colour(b.stencils, 2, all_of(b));
  const auto first = fresh.colour(a.stencils, 2, all_of(a)), second = used.colour(a.stencils, 2, all_of(a));
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].runs, second[i].runs);
    EXPECT_EQ(first[i].members, second[i].members);
  }
}

TEST(Colouring, UsesFewColoursForACoarseGrid) {
  // A particle of a triangulated grid has up to eight edges; first fit needs only a few more colours.
  const int n = 40;
  Constraints grid{n * n, 2, {}};
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      if (c + 1 < n) grid.stencils.insert(grid.stencils.end(), {r * n + c, r * n + c + 1});
      if (r + 1 < n) grid.stencils.insert(grid.stencils.end(), {r * n + c, (r + 1) * n + c});
      if (r + 1 < n && c + 1 < n) grid.stencils.insert(grid.stencils.end(), {r * n + c, (r + 1) * n + c + 1});
    }
  }
  EXPECT_LE(checked_colours(grid, all_of(grid)).size(), 16u);
}

}  // namespace
}  // namespace pliant
