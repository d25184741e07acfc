// Compares the solution over a forest of blocks with Gaussian elimination of the whole matrix.
#include "math/block_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace pliant {
namespace {

constexpr std::size_t most = most_of_block;

/// A block as the test makes it; BlockTree has all numbers in one array.
struct TestBlock {
  int parent = -1, size = 0;
  std::array<std::array<double, most>, most> diagonal{}, to_parent{};
  std::array<double, most> x{};
};
using Blocks = std::vector<TestBlock>;

void solve_block_tree(Blocks& blocks) {
  std::vector<BlockTree<double>::Block> shape;
  for (const TestBlock& block : blocks) shape.push_back({block.parent, block.size});
  BlockTree<double> tree;
  tree.reset(shape);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const auto stride = std::size_t(tree.stride()), size = std::size_t(blocks[n].size);
    for (std::size_t r = 0; r < size; ++r) {
      for (std::size_t c = r; c < size; ++c) tree.diagonal(n)[r * stride + c] = blocks[n].diagonal[c][r];
      std::copy_n(blocks[n].to_parent[r].begin(), stride, tree.to_parent(n) + r * stride);
    }
    std::copy_n(blocks[n].x.begin(), size, tree.x(n));
  }
  tree.solve();
  for (std::size_t n = 0; n < blocks.size(); ++n)
    std::copy_n(tree.x(n), std::size_t(blocks[n].size), blocks[n].x.begin());
}

/// Bodies and joints in turn: a joint's diagonal is zero or slightly negative, as compliance makes it.
Blocks random_forest(std::mt19937_64& random, int pairs, double compliance) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Blocks blocks;
  for (int i = 0; i < pairs; ++i) {
    TestBlock body, joint;
    body.size = i % 3 == 0 ? 3 : 6;
    for (int r = 0; r < body.size; ++r) body.diagonal[r][r] = 1 + 50 * (uniform(random) + 1);
    joint.size = 1 + i % std::min(body.size, 5);
    for (int r = 0; r < joint.size; ++r) joint.diagonal[r][r] = -compliance;
    body.parent = 2 * i + 1;  // a body's only way on is its joint
    for (int r = 0; r < body.size; ++r)
      for (int c = 0; c < joint.size; ++c) body.to_parent[r][c] = uniform(random);
    for (double& x : body.x) x = uniform(random);
    for (double& x : joint.x) x = uniform(random);
    blocks.push_back(body);
    blocks.push_back(joint);
  }
  TestBlock root;
  root.size = 6;
  for (int r = 0; r < 6; ++r) root.diagonal[r][r] = 7 + r;
  for (double& x : root.x) x = uniform(random);
  for (int i = 0; i < pairs; ++i) {  // to any later body, or to none: a joint with the ground
    TestBlock& joint = blocks[std::size_t(2 * i + 1)];
    std::uniform_int_distribution<int> later(i + 1, pairs + 1);
    const int to = later(random);
    if (to > pairs) continue;
    joint.parent = 2 * to;
    const int size = to == pairs ? 6 : blocks[std::size_t(2 * to)].size;
    for (int r = 0; r < joint.size; ++r)
      for (int c = 0; c < size; ++c) joint.to_parent[r][c] = uniform(random);
  }
  blocks.push_back(root);
  return blocks;
}

std::vector<double> solved_densely(const Blocks& blocks) {
  std::vector<int> first;
  int n = 0;
  for (const auto& block : blocks) {
    first.push_back(n);
    n += block.size;
  }
  std::vector<std::vector<double>> m(std::size_t(n), std::vector<double>(std::size_t(n) + 1));
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int r = 0; r < blocks[b].size; ++r) {
      const int row = first[b] + r;
      m[std::size_t(row)][std::size_t(n)] = blocks[b].x[std::size_t(r)];
      for (int c = 0; c < blocks[b].size; ++c)
        m[std::size_t(row)][std::size_t(first[b] + c)] = blocks[b].diagonal[std::size_t(r)][std::size_t(c)];
      if (blocks[b].parent < 0) continue;
      const auto parent = std::size_t(blocks[b].parent);
      for (int c = 0; c < blocks[parent].size; ++c) {
        const int column = first[parent] + c;
        m[std::size_t(row)][std::size_t(column)] = m[std::size_t(column)][std::size_t(row)] =
            blocks[b].to_parent[std::size_t(r)][std::size_t(c)];
      }
    }
  for (std::size_t i = 0; i < std::size_t(n); ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i; r < std::size_t(n); ++r)
      if (std::fabs(m[r][i]) > std::fabs(m[pivot][i])) pivot = r;
    std::swap(m[i], m[pivot]);
    for (std::size_t r = 0; r < std::size_t(n); ++r) {
      if (r == i) continue;
      const double factor = m[r][i] / m[i][i];
      for (std::size_t c = i; c <= std::size_t(n); ++c) m[r][c] -= factor * m[i][c];
    }
  }
  std::vector<double> x;
  for (std::size_t i = 0; i < std::size_t(n); ++i) x.push_back(m[i][std::size_t(n)] / m[i][i]);
  return x;
}

TEST(BlockTree, AgreesWithEliminationOfTheWholeMatrix) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    Blocks blocks = random_forest(random, 1 + trial % 12, trial % 2 == 0 ? 0 : 0.3);
    const std::vector<double> expected = solved_densely(blocks);
    solve_block_tree(blocks);
    std::size_t i = 0;
    for (const auto& block : blocks)
      for (int r = 0; r < block.size; ++r, ++i)
        ASSERT_NEAR(block.x[std::size_t(r)], expected[i], 1e-8 * (1 + std::fabs(expected[i]))) << trial << ' ' << i;
  }
}

/// A row that says the same as another one is left out, and the rest is solved.
TEST(BlockTree, RepeatedRowsAreLeftOut) {
  Blocks blocks(2);
  blocks[0].size = 3;
  for (int r = 0; r < 3; ++r) blocks[0].diagonal[std::size_t(r)][std::size_t(r)] = 2;
  blocks[0].parent = 1;
  blocks[0].to_parent = {{{1, 1}}};  // two rows, both the first coordinate
  blocks[1].size = 2;
  blocks[1].x = {0.5, 0.5};  // which shall be 0.5
  solve_block_tree(blocks);
  EXPECT_NEAR(blocks[0].x[0], 0.5, 1e-12);
  EXPECT_EQ(blocks[1].x[1], 0);
}

/// Also inside of a block, where a joint's rows have no diagonal of their own.
TEST(BlockTree, RepeatedRowsOfABlockAreLeftOut) {
  Blocks blocks(1);
  blocks[0].size = 6;
  for (int r = 0; r < 3; ++r) blocks[0].diagonal[std::size_t(r)][std::size_t(r)] = 3 + r;
  const double rows[3][3] = {{0.3, 0.1, 0.7}, {0.2, -0.4, 0.1}, {0.5, -0.3, 0.8}};  // the third is the sum
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) blocks[0].diagonal[std::size_t(3 + r)][std::size_t(c)] = rows[r][c];
  for (int r = 0; r < 3; ++r) blocks[0].x[std::size_t(3 + r)] = r < 2 ? 0.01 : 0.021;  // and demands 1 mm more
  solve_block_tree(blocks);
  EXPECT_EQ(blocks[0].x[5], 0);
  for (int r = 0; r < 2; ++r) {
    double change = 0;
    for (int c = 0; c < 3; ++c) change += rows[r][c] * blocks[0].x[std::size_t(c)];
    EXPECT_NEAR(change, 0.01, 1e-12) << r;
  }
}

}  // namespace
}  // namespace pliant
