// Direct solution of symmetric systems whose blocks form a forest, in time linear in the number of blocks.
//
// Bodies and the joints between them are such blocks: (M, J^T; J, -compliance). Eliminated from the leaves on, no block fills
// in (Baraff 1996, "Linear-time dynamics using Lagrange multipliers").
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace pliant {

constexpr int most_of_block = 16;  ///< unknowns of a block: a body's six, and those of its joint with the ground

/// One block: its part of the matrix and of the right-hand side, which the solution replaces.
template <class R>
struct TreeBlock {
  using Matrix = std::array<std::array<R, most_of_block>, most_of_block>;

  int parent = -1;                   ///< a later block; -1: a root
  int size = 0;                      ///< unknowns, 1 to most_of_block
  Matrix diagonal{};                 ///< symmetric; only the lower half is read
  Matrix to_parent{};                ///< rows of this block, columns of its parent
  std::array<R, most_of_block> x{};  ///< right-hand side, then solution
};

namespace block_tree {

/// A pivot below this share of the terms that made it is rounding: its unknown depends on earlier ones and becomes zero.
template <class R>
constexpr R least_pivot = R(1e-6);

/// L D L^T of a block in place. Returns which unknowns are lost.
template <class R>
std::array<bool, most_of_block> factorise(TreeBlock<R>& block) {
  std::array<bool, most_of_block> lost{};
  auto& m = block.diagonal;
  for (int i = 0; i < block.size; ++i) {
    R whole = m[i][i] < 0 ? -m[i][i] : m[i][i];
    for (int j = 0; j <= i; ++j) {
      R left = m[i][j];
      for (int k = 0; k < j; ++k) {
        const R term = m[i][k] * m[k][k] * m[j][k], size = term < 0 ? -term : term;
        if (i == j && size > whole) whole = size;
        left = left - term;
      }
      m[i][j] = i == j ? left : lost[j] ? R(0) : left / m[j][j];
    }
    const R pivot = m[i][i] < 0 ? -m[i][i] : m[i][i];
    lost[i] = !(pivot > least_pivot<R> * whole);
  }
  return lost;
}

/// Replaces the right-hand sides in columns [0, columns) of b by their solutions, with the factors of a block. Columns are the
/// inner loop, so that a compiler can handle several at once.
template <class R, std::size_t width>
void solve_columns(const TreeBlock<R>& block, const std::array<bool, most_of_block>& lost, int columns,
                   std::array<std::array<R, width>, most_of_block>& b) {
  const auto& m = block.diagonal;
  for (int i = 0; i < block.size; ++i)
    for (int j = 0; j < i; ++j)
      for (int c = 0; c < columns; ++c) b[i][c] = b[i][c] - m[i][j] * b[j][c];
  for (int i = 0; i < block.size; ++i)
    for (int c = 0; c < columns; ++c) b[i][c] = lost[i] ? R(0) : b[i][c] / m[i][i];
  for (int i = block.size; i-- > 0;)
    for (int j = i + 1; j < block.size; ++j)
      for (int c = 0; c < columns; ++c) b[i][c] = b[i][c] - m[j][i] * b[j][c];
}

/// Solves with the factors of a block.
template <class R>
std::array<R, most_of_block> solved(const TreeBlock<R>& block, const std::array<bool, most_of_block>& lost,
                                    const std::array<R, most_of_block>& right) {
  std::array<std::array<R, 1>, most_of_block> b;
  for (int i = 0; i < most_of_block; ++i) b[i][0] = right[i];
  solve_columns(block, lost, 1, b);
  std::array<R, most_of_block> x;
  for (int i = 0; i < most_of_block; ++i) x[i] = b[i][0];
  return x;
}

/// Subtracts what eliminating a block leaves in its parent, and replaces its coupling by that times the inverse diagonal.
template <class R>
void eliminate(TreeBlock<R>& block, TreeBlock<R>& parent) {
  const std::array<bool, most_of_block> lost = factorise(block);
  block.x = solved(block, lost, block.x);
  typename TreeBlock<R>::Matrix coupling;
  for (int r = 0; r < block.size; ++r)
    for (int c = 0; c < parent.size; ++c) coupling[r][c] = block.to_parent[r][c];
  solve_columns(block, lost, parent.size, block.to_parent);
  for (int c = 0; c < parent.size; ++c)
    for (int r = 0; r < block.size; ++r) {
      if (coupling[r][c] == R(0)) continue;  // half of a joint's gradients are, as those by displacements
      parent.x[c] = parent.x[c] - coupling[r][c] * block.x[r];
      for (int d = 0; d <= c; ++d) parent.diagonal[c][d] = parent.diagonal[c][d] - coupling[r][c] * block.to_parent[r][d];
    }
}

}  // namespace block_tree

/// Solves in place. Children come before their parents; the order decides the bits.
template <class R>
void solve_block_tree(std::vector<TreeBlock<R>>& blocks) {
  for (TreeBlock<R>& block : blocks) {
    if (block.parent >= 0) {
      block_tree::eliminate(block, blocks[static_cast<std::size_t>(block.parent)]);
      continue;
    }
    const std::array<bool, most_of_block> lost = block_tree::factorise(block);
    block.x = block_tree::solved(block, lost, block.x);
  }
  for (std::size_t i = blocks.size(); i-- > 0;) {
    TreeBlock<R>& block = blocks[i];
    if (block.parent < 0) continue;
    const TreeBlock<R>& parent = blocks[static_cast<std::size_t>(block.parent)];
    for (int r = 0; r < block.size; ++r)
      for (int c = 0; c < parent.size; ++c) block.x[r] = block.x[r] - block.to_parent[r][c] * parent.x[c];
  }
}

}  // namespace pliant
