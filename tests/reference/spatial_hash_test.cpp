// Compares the spatial hash with brute force: boxes and points, cells much smaller and much larger than these, and
// coordinates beyond the last cell.
#include "reference/spatial_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "pliant/error.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using Pairs = std::vector<std::pair<int, int>>;
using testing_support::nasty_kinds;

std::vector<BoxBounds> boxes_of(const std::vector<testing_support::Corners3>& triangles, float margin) {
  std::vector<BoxBounds> boxes;
  for (const auto& t : triangles) boxes.push_back(BoxBounds::of(t.data(), 3).grown(margin));
  return boxes;
}

Pairs brute_pairs(const std::vector<BoxBounds>& boxes) {
  Pairs pairs;
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b)
      if (overlap(boxes[a], boxes[b])) pairs.emplace_back(a, b);
  return pairs;
}

Pairs pairs_of(const SpatialHash& hash) {
  Pairs pairs;
  hash.self_pairs([&](int a, int b) { pairs.emplace_back(a, b); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(SpatialHash, FindsExactlyBruteForcesPairsInTenThousandNastySets) {
  std::mt19937_64 random(71);
  std::size_t found = 0;
  for (int i = 0; i < 10000; ++i) {
    const int kind = i % nasty_kinds;
    SpatialHash hash(i % 5 == 0 ? 0.02f : i % 5 == 1 ? 100.f : i % 5 == 2 ? 1.f : 0.25f);
    const auto boxes = boxes_of(testing_support::nasty_triangles(random, kind), i % 2 == 0 ? 0 : 0.1f);
    hash.build(boxes);
    const Pairs expected = brute_pairs(boxes);
    ASSERT_EQ(pairs_of(hash), expected) << i;
    found += expected.size();
    for (const BoxBounds& box : boxes_of(testing_support::nasty_triangles(random, kind), 0)) {
      std::vector<int> hit, overlapping;
      hash.query(box, [&](int k) { hit.push_back(k); });
      for (int k = 0; k < static_cast<int>(boxes.size()); ++k)
        if (overlap(boxes[static_cast<std::size_t>(k)], box)) overlapping.push_back(k);
      std::sort(hit.begin(), hit.end());
      ASSERT_EQ(hit, overlapping) << i;
    }
  }
  EXPECT_GT(found, 100000u);
}

TEST(SpatialHash, FindsPointsWithinARadius) {
  std::mt19937_64 random(72);
  for (const Vec3f& far : {Vec3f{0, 0, 0}, Vec3f{-5000, 3000, -1e6f}}) {
    std::vector<Vec3f> points;
    std::vector<BoxBounds> boxes;
    for (int i = 0; i < 1500; ++i) {
      points.push_back(far + testing_support::random_vector(random, 1));
      if (i % 10 == 0)
        points.back() = far + Vec3f{static_cast<float>(i % 7) * 0.125f, 0.25f, -0.5f};  // on cell boundaries
      boxes.push_back({points.back(), points.back()});
    }
    const float radius = 0.125f;
    SpatialHash hash(radius);
    hash.build(boxes);
    const auto near = [&](std::size_t a, std::size_t b) {
      return length_squared(convert<double>(points[a]) - convert<double>(points[b])) <=
             static_cast<double>(radius) * static_cast<double>(radius);
    };
    Pairs pairs, expected;
    for (std::size_t a = 0; a < points.size(); ++a) {
      hash.query(boxes[a].grown(radius), [&](int b) {
        if (static_cast<int>(a) < b && near(a, static_cast<std::size_t>(b))) pairs.emplace_back(a, b);
      });
      for (std::size_t b = a + 1; b < points.size(); ++b)
        if (near(a, b)) expected.emplace_back(a, b);
    }
    std::sort(pairs.begin(), pairs.end());
    ASSERT_EQ(pairs, expected);
    EXPECT_GT(pairs.size(), 1000u);
  }
}

TEST(SpatialHash, GrowsAndShrinksAndDropsNothing) {
  SpatialHash hash(0.1f);
  EXPECT_TRUE(pairs_of(hash).empty());
  for (const std::size_t n : {3u, 1000u, 10u, 300u, 0u}) {
    const std::vector<BoxBounds> same(n, BoxBounds{{1, 2, 3}, {1.05f, 2.05f, 3.05f}});
    hash.build(same);
    EXPECT_EQ(pairs_of(hash).size(), n * (n - std::min<std::size_t>(n, 1)) / 2);
  }
}

TEST(SpatialHash, HoldsOutAtTheEndsOfItsCells) {
  const float huge = 1e30f;
  const std::vector<BoxBounds> boxes{{{huge, huge, huge}, {huge, huge, huge}},
                                     {{huge, huge, huge}, {2 * huge, 2 * huge, 2 * huge}},
                                     {{-huge, -huge, -huge}, {huge, huge, huge}},
                                     {{-huge, 0, 0}, {-huge, 0, 0}}};
  SpatialHash hash(1e-3f);
  hash.build(boxes);
  EXPECT_EQ(pairs_of(hash), brute_pairs(boxes));
  EXPECT_THROW(SpatialHash(0), Error);
  EXPECT_THROW(SpatialHash(-1), Error);
}

}  // namespace
}  // namespace pliant
