// Pairs of boxes by one tree for each family, against all pairs.
#include "collision/bodies/body_crowds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

namespace pliant {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

struct BoxFamilies {
  std::vector<BoxBounds> boxes;
  std::vector<int> family;

  bool may_touch(int i, int j) const {
    const int a = family[static_cast<std::size_t>(i)], b = family[static_cast<std::size_t>(j)];
    return i != j && (a < 0 || a != b || std::count(family.begin(), family.end(), a) < 64);
  }
  bool do_overlap(int i, int j) const {
    return overlap(boxes[static_cast<std::size_t>(i)], boxes[static_cast<std::size_t>(j)]);
  }
};

/// Boxes at random places; `sizes` has the number of those without a family, then of each family.
BoxFamilies random_boxes(const std::vector<int>& sizes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0, 1), size(0.01f, 0.1f);
  BoxFamilies out;
  for (int family = 0; family < static_cast<int>(sizes.size()); ++family)
    out.family.insert(out.family.end(), static_cast<std::size_t>(sizes[static_cast<std::size_t>(family)]), family - 1);
  std::shuffle(out.family.begin(), out.family.end(), random);
  for (std::size_t i = 0; i < out.family.size(); ++i) {
    const Vec3f low{place(random), place(random), place(random)};
    out.boxes.push_back({low, low + Vec3f{size(random), size(random), size(random)}});
  }
  return out;
}

Pairs all_pairs(const BoxFamilies& of) {
  Pairs out;
  for (int i = 0; i < static_cast<int>(of.boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(of.boxes.size()); ++j)
      if (of.may_touch(i, j) && of.do_overlap(i, j)) out.emplace_back(i, j);
  return out;
}

TEST(BodyCrowds, FindThePairsOfAllButFamilies) {
  for (const std::vector<int>& sizes :
       {std::vector<int>{300}, {0, 200}, {1, 500}, {200, 100, 150}, {50, 20, 300}, {0, 70, 80, 90}}) {
    const BoxFamilies of = random_boxes(sizes, 7);
    BodyCrowds crowds(of.family);
    crowds.build(of.boxes);
    Pairs found;
    std::vector<int> packs, hits;
    for (int task = 0; task < crowds.tasks(); ++task)
      crowds.overlaps(task, packs, hits, [&](int i, const std::vector<int>& others) {
        for (const int j : others)
          if (i != j) found.emplace_back(std::minmax(i, j));
      });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    const Pairs expected = all_pairs(of);
    EXPECT_FALSE(sizes[0] > 1 && expected.empty());
    EXPECT_EQ(found, expected) << sizes.size();
  }
}

TEST(BodyCrowds, AQueryFindsAllButTheOwnFamily) {
  const BoxFamilies of = random_boxes({100, 150, 30}, 3);
  BodyCrowds crowds(of.family);
  crowds.build(of.boxes);
  for (int i = 0; i < static_cast<int>(of.boxes.size()); ++i) {
    std::vector<int> found, expected;
    crowds.query(of.boxes[static_cast<std::size_t>(i)], i, [&](int j) {
      if (i != j) found.push_back(j);
    });
    for (int j = 0; j < static_cast<int>(of.boxes.size()); ++j)
      if (of.may_touch(i, j) && of.do_overlap(i, j)) expected.push_back(j);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << i;
  }
}

}  // namespace
}  // namespace pliant
