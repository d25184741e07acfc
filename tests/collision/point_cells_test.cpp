// Tests the cells of points against brute force.
#include "collision/broad/point_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>

#include "collision/points_support.h"

namespace pliant {
namespace {

using testing_support::is_inside;

std::vector<Record> random_points(int count, Vec3f size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Record> points;
  for (int i = 0; i < count; ++i)
    points.push_back({unit(random) * size.x, unit(random) * size.y, unit(random) * size.z, 1});
  return points;
}

/// Every point in a box is found, once, in ascending order; those beside it by less than two cells are all that is
/// found besides.
void expect_as_brute_force(const std::vector<Record>& points, int first, int last, const BoxBounds& box, float cell) {
  PointCells cells;
  cells.build(points.data(), first, last);
  std::vector<std::int32_t> found{-7};
  cells.query(box, found);
  ASSERT_EQ(found.front(), -7);
  found.erase(found.begin());
  EXPECT_TRUE(std::adjacent_find(found.begin(), found.end(), [](int a, int b) { return a >= b; }) == found.end());
  const BoxBounds around = box.grown(2 * cell);
  for (int i = first; i < last; ++i) {
    const bool is_found = std::binary_search(found.begin(), found.end(), i);
    const Record& p = points[static_cast<std::size_t>(i)];
    EXPECT_TRUE(is_found || !is_inside(p, box)) << i;
    EXPECT_TRUE(!is_found || is_inside(p, around)) << i;
  }
  for (const std::int32_t i : found) EXPECT_TRUE(i >= first && i < last);
}

TEST(PointCells, FindWhatBruteForceFinds) {
  const Vec3f sizes[] = {{1, 1, 1}, {3, 0.01f, 2}, {0, 0, 4}, {0, 0, 0}};
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Vec3f size = sizes[seed % 4];
    const std::vector<Record> points = random_points(300, size, seed),
                              corners = random_points(2, {2, 2, 2}, seed + 100);
    const Vec3f p{corners[0].x, corners[0].y, corners[0].z}, q{corners[1].x, corners[1].y, corners[1].z};
    const float cell = 2 * std::max(size.x, std::max(size.y, size.z)) / 16;
    expect_as_brute_force(points, 20, 280, {min(p, q), max(p, q)}, cell);
    expect_as_brute_force(points, 0, 300, {Vec3f{-9, -9, -9}, Vec3f{9, 9, 9}}, cell);
  }
}

TEST(PointCells, OfNoPointsFindNone) {
  PointCells cells;
  std::vector<std::int32_t> found;
  cells.query({{-1, -1, -1}, {1, 1, 1}}, found);
  cells.build(nullptr, 0, 0);
  cells.query({{-1, -1, -1}, {1, 1, 1}}, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace pliant
