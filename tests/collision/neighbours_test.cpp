// Lists of neighbours against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "collision/neighbours/neighbour_lists.h"
#include "levels/compiled.h"
#include "math/runs_level.h"

namespace pliant {
namespace {

constexpr float search_radius = 0.1f;

std::vector<Record> cloud(int count, float size, unsigned seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return size * static_cast<float>(random() % 100000) / 100000 - size / 3; };
  std::vector<Record> points;
  for (int i = 0; i < count; ++i) {
    const float x = next(), y = next(), z = next();
    points.push_back({x, y, z, 0});
  }
  return points;
}

/// The neighbours of each point, by the numbers of points, ascending.
std::vector<std::vector<int>> by_brute_force(const std::vector<Record>& points) {
  std::vector<std::vector<int>> found(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j) {
      const float dx = points[i].x - points[j].x, dy = points[i].y - points[j].y, dz = points[i].z - points[j].z;
      if (i != j && dx * dx + dy * dy + dz * dz <= search_radius * search_radius)
        found[i].push_back(static_cast<int>(j));
    }
  return found;
}

std::vector<std::vector<int>> by_lists(const std::vector<Record>& points, const NeighbourKernels& kernels,
                                       int threads = 1) {
  Executor executor(threads);
  NeighbourLists lists;
  lists.find(executor, kernels, points, search_radius);
  const std::vector<std::int32_t>& order = lists.order().points();
  std::vector<std::vector<int>> found(points.size());
  for (int slot = 0; slot < lists.slots(); ++slot) {
    const NeighbourGroup& group = lists.group(slot / 16);
    std::int32_t before = -1;
    for (int k = 0; k < group.rows; ++k) {
      const std::int32_t other = group.slots[16 * k + slot % 16];
      if (other == lists.nobody()) continue;
      EXPECT_GT(other, before) << "lists ascend";
      before = other;
      found[static_cast<std::size_t>(order[static_cast<std::size_t>(slot)])].push_back(
          order[static_cast<std::size_t>(other)]);
    }
  }
  for (std::vector<int>& one : found) std::sort(one.begin(), one.end());
  return found;
}

struct Level {
  const char* name;
  const NeighbourKernels& (*kernels)();
};

std::vector<Level> levels() {
  std::vector<Level> all{{"sequential", neighbour_kernels_sequential}};
#define PLIANT_ADD_LEVEL(suffix, isa, ...) \
  if (runs_##suffix()) all.push_back({isa, neighbour_kernels_##suffix});
  PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_ADD_LEVEL, )
#undef PLIANT_ADD_LEVEL
  return all;
}

TEST(Neighbours, AreThoseOfBruteForceAtAnyDensity) {
  for (const float size : {0.35f, 0.6f, 5.f, 300.f}) {
    const std::vector<Record> points = cloud(701, size, 3);
    const auto expected = by_brute_force(points);
    for (const Level& level : levels())
      EXPECT_EQ(by_lists(points, level.kernels()), expected) << size << ' ' << level.name;
    EXPECT_EQ(by_lists(points, PLIANT_OF_BASE_LEVEL(neighbour_kernels)(), 3), expected) << "on three threads";
  }
}

TEST(Neighbours, AreFoundFarFromTheOriginAndBeyondTheGrid) {
  for (const float far : {1000.f, -3e5f, 1e9f}) {
    std::vector<Record> points = cloud(200, 0.5f, 5);
    for (std::size_t i = 0; i < points.size(); i += 2) points[i].x += far;
    EXPECT_EQ(by_lists(points, PLIANT_OF_BASE_LEVEL(neighbour_kernels)()), by_brute_force(points)) << far;
  }
}

TEST(Neighbours, AreFoundBesidePointsAtBothEndsOfTheGrid) {
  std::vector<Record> points = cloud(300, 0.5f, 11);
  points[0] = {1e8f, 1e8f, 1e8f, 0};
  points[1] = {-1e8f, -1e8f, -1e8f, 0};
  EXPECT_EQ(by_lists(points, PLIANT_OF_BASE_LEVEL(neighbour_kernels)()), by_brute_force(points));
}

TEST(Neighbours, AreFoundBesideThousandsOfCandidatesThatAreNone) {
  constexpr int crowd = 563 * 16;  // whole groups, in the row of cells before that of the others
  std::vector<Record> points = cloud(crowd, 0.02f, 13);
  for (Record& p : points) p = {p.x + 0.15f, p.y + 0.05f, p.z - 0.02f, 0};
  for (int i = 0; i < 16; ++i)
    points.push_back({i < 8 ? 0.f : 0.29f, 0.05f, 0.05f + 0.001f * static_cast<float>(i), 0});
  for (const Level& level : levels())
    for (const int threads : {1, 3}) {
      Executor executor(threads);
      NeighbourLists lists;
      lists.find(executor, level.kernels(), points, search_radius);
      EXPECT_EQ(lists.left_out(), crowd) << level.name;
      EXPECT_EQ(lists.group(0).rows, most_neighbours) << level.name;
      ASSERT_EQ(lists.group(563).rows, 7) << level.name;
      for (int lane = 0; lane < 16; ++lane)
        for (int k = 0; k < 7; ++k) {
          const int other = lane / 8 * 8 + k;
          EXPECT_EQ(lists.group(563).slots[16 * k + lane], crowd + (other < lane ? other : other + 1)) << level.name;
        }
    }
}

TEST(Neighbours, OfNoPointAndOfOneAreNone) {
  EXPECT_TRUE(by_lists({}, PLIANT_OF_BASE_LEVEL(neighbour_kernels)()).empty());
  EXPECT_TRUE(by_lists({{1, 2, 3, 0}}, PLIANT_OF_BASE_LEVEL(neighbour_kernels)()).front().empty());
}

TEST(Neighbours, OfPlacesThatAreNotFiniteAreNone) {
  std::vector<Record> points = cloud(40, 0.2f, 7);
  points[3].x = NAN;
  points[9].y = INFINITY;
  points[11].z = -INFINITY;
  for (const Level& level : levels())
    EXPECT_EQ(by_lists(points, level.kernels()), by_brute_force(points)) << level.name;
}

TEST(Neighbours, BeyondTheLargestNumberAreCounted) {
  const std::vector<Record> points(most_neighbours + 44, Record{1, 1, 1, 0});
  for (const Level& level : levels()) {
    Executor executor(1);
    NeighbourLists lists;
    lists.find(executor, level.kernels(), points, search_radius);
    EXPECT_EQ(lists.left_out(), most_neighbours + 44) << level.name;
    EXPECT_EQ(lists.group(0).rows, most_neighbours) << level.name;
  }
}

TEST(Neighbours, ConsecutiveSlotsOfALiquidLieTogether) {
  std::vector<Record> points;
  for (float z = 0; z < 12; ++z)
    for (float y = 0; y < 12; ++y)
      for (float x = 0; x < 60; ++x) points.push_back({0.05f * x, 0.05f * y, 0.05f * z, 0});
  Executor executor(1);
  CellOrder order;
  order.sort(executor, points, search_radius);
  for (std::size_t slot = 1; slot < points.size(); ++slot) {
    const Record &a = points[order.points()[slot - 1]], &b = points[order.points()[slot]];
    EXPECT_LT(std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}), 2 * search_radius) << slot;
  }
}

TEST(Neighbours, OfAStrayPointCostNoMemory) {
  std::vector<Record> points = cloud(2000, 1, 9);
  Executor executor(1);
  NeighbourLists near, stray;
  near.find(executor, PLIANT_OF_BASE_LEVEL(neighbour_kernels)(), points, search_radius);
  points.back() = {9000, -4000, 2e4f, 0};
  stray.find(executor, PLIANT_OF_BASE_LEVEL(neighbour_kernels)(), points, search_radius);
  EXPECT_LT(stray.bytes(), near.bytes() + near.bytes() / 4);
}

}  // namespace
}  // namespace pliant
