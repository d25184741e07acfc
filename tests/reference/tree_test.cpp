// Compares every BVH with brute force over its own volumes, and every volume with the distances of what it encloses.
#include "collision/broad/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/triangle.h"
#include "reference/volumes.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using testing_support::Corners3;
using testing_support::nasty_kinds;
using testing_support::nasty_triangles;
using Pairs = std::vector<std::pair<int, int>>;

template <class B>
std::vector<B> bounds_of(const std::vector<Corners3>& triangles, float margin) {
  std::vector<B> all;
  for (const Corners3& t : triangles) all.push_back(B::of(t.data(), 3).grown(margin));
  return all;
}

template <class B>
Pairs brute_pairs(const std::vector<B>& a, const std::vector<B>& b, bool self) {
  Pairs pairs;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = self ? i + 1 : 0; k < b.size(); ++k)
      if (overlap(a[i], b[k])) pairs.emplace_back(static_cast<int>(i), static_cast<int>(k));
  return pairs;
}

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <class T>
class TreeOf : public testing::Test {};
struct BoxByTwo {
  using Volume = BoxBounds;
  static constexpr int fanout = 2;
};
template <class B>
struct ByEight {
  using Volume = B;
  static constexpr int fanout = 8;
};
using Kinds = testing::Types<ByEight<BoxBounds>, BoxByTwo, ByEight<SphereBounds>, ByEight<OrientedBoxBounds>,
                             ByEight<KDopBounds<14>>, ByEight<KDopBounds<18>>>;
TYPED_TEST_SUITE(TreeOf, Kinds);

TYPED_TEST(TreeOf, FindsExactlyBruteForcesPairsInTenThousandNastySets) {
  using B = typename TypeParam::Volume;
  std::mt19937_64 random(31);
  Tree<B, TypeParam::fanout> tree, other;
  std::size_t found = 0;
  for (int i = 0; i < 10000; ++i) {
    const int kind = i % nasty_kinds;
    const float margin = i % 4 == 0 ? 0 : i % 4 == 1 ? 0.05f : 0.2f;
    const auto a = bounds_of<B>(nasty_triangles(random, kind), margin);
    tree.build(a);
    Pairs pairs;
    tree.self_pairs([&](int x, int y) { pairs.emplace_back(x, y); });
    ASSERT_EQ(sorted(pairs), brute_pairs(a, a, true)) << "set " << i;
    found += pairs.size();
    if (i % 4 != 0) continue;
    const auto b = bounds_of<B>(nasty_triangles(random, kind), margin);
    other.build(b);
    pairs.clear();
    tree.pairs(other, [&](int x, int y) { pairs.emplace_back(x, y); });
    ASSERT_EQ(sorted(pairs), brute_pairs(a, b, false)) << "set " << i;
    pairs.clear();
    for (std::size_t k = 0; k < b.size(); ++k)
      tree.query(b[k], [&](int x) { pairs.emplace_back(x, static_cast<int>(k)); });
    ASSERT_EQ(sorted(pairs), brute_pairs(a, b, false)) << "set " << i;
  }
  EXPECT_GT(found, 100000u);
}

TYPED_TEST(TreeOf, MissesNoPairThatIsWithinTheMargin) {
  using B = typename TypeParam::Volume;
  std::mt19937_64 random(32);
  Tree<B, TypeParam::fanout> tree;
  int close = 0;
  for (int i = 0; i < 600; ++i) {
    const auto triangles = nasty_triangles(random, i % nasty_kinds);
    const float radius = 0.1f;
    tree.build(bounds_of<B>(triangles, radius / 2));
    Pairs pairs;
    tree.self_pairs([&](int x, int y) { pairs.emplace_back(x, y); });
    pairs = sorted(pairs);
    for (std::size_t a = 0; a < triangles.size(); ++a)
      for (std::size_t b = a + 1; b < triangles.size(); ++b) {
        double least = 1e9;
        const auto& s = triangles[a];
        const auto& t = triangles[b];
        for (int k = 0; k < 3; ++k) {
          const auto p = [&](const Vec3f& v) { return convert<double>(v); };
          least = std::min(least, closest_on_triangle(p(s[k]), p(t[0]), p(t[1]), p(t[2])).distance_squared);
          least = std::min(least, closest_on_triangle(p(t[k]), p(s[0]), p(s[1]), p(s[2])).distance_squared);
          for (int m = 0; m < 3; ++m)
            least =
                std::min(least, closest_on_segments<double>({p(s[k]), p(s[(k + 1) % 3])}, {p(t[m]), p(t[(m + 1) % 3])})
                                    .distance_squared);
        }
        if (std::sqrt(least) > static_cast<double>(radius)) continue;
        ++close;
        const std::pair<int, int> pair(static_cast<int>(a), static_cast<int>(b));
        ASSERT_TRUE(std::binary_search(pairs.begin(), pairs.end(), pair)) << i;
      }
  }
  EXPECT_GT(close, 5000);
}

TYPED_TEST(TreeOf, RefittedFindsWhatOneBuiltAnewFinds) {
  using B = typename TypeParam::Volume;
  std::mt19937_64 random(33);
  std::vector<Corners3> triangles;
  for (int i = 0; i < 300; ++i) triangles.push_back(testing_support::random_triangle(random, 2, 0.2f));
  Tree<B, TypeParam::fanout> tree;
  tree.build(bounds_of<B>(triangles, 0));
  for (int frame = 0; frame < 5; ++frame) {
    for (Corners3& t : triangles) {
      const Vec3f move = testing_support::random_vector(random, 1);
      for (Vec3f& p : t) p = p + move;
    }
    const auto moved = bounds_of<B>(triangles, 0.01f);
    tree.refit(moved);
    Pairs pairs;
    tree.self_pairs([&](int a, int b) { pairs.emplace_back(a, b); });
    ASSERT_EQ(sorted(pairs), brute_pairs(moved, moved, true));
  }
}

TYPED_TEST(TreeOf, FindsTheClosestAndTheFirstOfEquals) {
  using B = typename TypeParam::Volume;
  std::mt19937_64 random(34);
  Tree<B, TypeParam::fanout> tree;
  for (int i = 0; i < 1500; ++i) {
    const auto triangles = nasty_triangles(random, i % nasty_kinds);
    tree.build(bounds_of<B>(triangles, 0));
    const Vec3f p =
        testing_support::random_vector(random, 2) + (i % nasty_kinds == 2 ? Vec3f{-4096, 8191, 1e5f} : Vec3f{});
    const auto distance = [&](int leaf) {
      const Corners3& t = triangles[static_cast<std::size_t>(leaf)];
      const auto found =
          closest_on_triangle(convert<double>(p), convert<double>(t[0]), convert<double>(t[1]), convert<double>(t[2]));
      return static_cast<float>(std::sqrt(found.distance_squared));
    };
    std::pair<int, float> expected{-1, 3.f};
    for (int leaf = 0; leaf < static_cast<int>(triangles.size()); ++leaf)
      if (distance(leaf) < expected.second) expected = {leaf, distance(leaf)};
    ASSERT_EQ(tree.closest(p, 3.f, distance), expected) << i;
  }
}

TYPED_TEST(TreeOf, HoldsThePointsAndNoMoreThanItShould) {
  using B = typename TypeParam::Volume;
  std::mt19937_64 random(35);
  for (int i = 0; i < 2000; ++i) {
    const auto triangles = nasty_triangles(random, i % nasty_kinds);
    if (triangles.empty()) continue;
    const auto leaves = bounds_of<B>(triangles, 0);
    const B all = B::merged(leaves.data(), static_cast<int>(leaves.size()));
    for (std::size_t k = 0; k < triangles.size(); ++k)
      for (const Vec3f& p : triangles[k]) {
        ASSERT_TRUE(overlap(all, B::of(&p, 1))) << i;
        ASSERT_EQ(all.distance_bound(p), 0) << i;
        const Vec3f beside = p + testing_support::random_vector(random, 1);
        const double away = length(convert<double>(beside) - convert<double>(p));
        ASSERT_LE(all.distance_bound(beside), away * (1 + 1e-6));
        ASSERT_TRUE(overlap(leaves[k].grown(detail::float_above(away)), B::of(&beside, 1))) << i;
      }
    // The middle is at most some diagonals away from the points, and a box ten diagonals away overlaps nothing.
    const BoxBounds box =
        BoxBounds::merged(bounds_of<BoxBounds>(triangles, 0).data(), static_cast<int>(triangles.size()));
    const Vec3f outside = box.high + 10.f * (box.high - box.low) + Vec3f{1, 1, 1};
    ASSERT_FALSE(overlap(all, B::of(&outside, 1))) << i;
  }
}

TEST(Morton, OrdersByCodeThenNumber) {
  MortonSorter sorter;
  std::vector<int> order;
  sorter.sort({{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, order);
  EXPECT_EQ(order, (std::vector<int>{1, 3, 4, 5, 0, 2}));
  sorter.sort({}, order);
  EXPECT_TRUE(order.empty());
  const float nan = std::nanf("");
  sorter.sort({{5, 5, 5}, {nan, 1, 1}, {1, 1, 1}}, order);
  EXPECT_EQ(order, (std::vector<int>{1, 2, 0}));
}

}  // namespace
}  // namespace pliant
