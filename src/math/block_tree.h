// Direct solution of symmetric systems whose blocks form a forest, in time linear in the number of blocks.
//
// Bodies and the joints between them are such blocks: (M, J^T; J, -compliance). Eliminated from the leaves on, no block
// fills in (Baraff 1996, "Linear-time dynamics using Lagrange multipliers").
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "math/scalar.h"

namespace pliant {

constexpr int most_of_block = 16;  ///< unknowns of a block: a body's six, and those of its joint with the ground

/// A system of blocks. Rows of all matrices are `stride()` numbers apart.
template <class R>
class BlockTree {
 public:
  struct Block {
    int parent = -1;  ///< a later block; -1: a root
    int size = 0;     ///< unknowns, 1 to most_of_block

    bool operator==(const Block&) const = default;
  };

  /// Replaces the blocks. All numbers become zero.
  void reset(std::vector<Block> blocks);
  const std::vector<Block>& blocks() const { return blocks_; }
  int stride() const { return stride_; }
  void set_to_zero() { std::fill(values_.begin(), values_.end(), R(0)); }

  /// The matrix of a block, which is symmetric; only its upper half is read.
  R* diagonal(std::size_t block) { return values_.data() + first_[block]; }
  /// Rows of this block, columns of its parent.
  R* to_parent(std::size_t block) { return diagonal(block) + blocks_[block].size * stride_; }
  /// The right-hand side, then the solution.
  R* x(std::size_t block) { return diagonal(block) + 2 * blocks_[block].size * stride_; }

  /// Solves in place. Children come before their parents; the order decides the bits.
  void solve();

 private:
  template <int width>
  void solve_rows();

  std::vector<Block> blocks_;
  std::vector<int> first_;  ///< [block] of its numbers in values_
  std::vector<R> values_;
  int stride_ = 4;  ///< 4, 8 or 16, so that a compiler handles rows by whole registers
};

namespace block_tree {

/// The larger of two numbers; a if neither is.
template <class R>
PLIANT_HD R larger(const R& a, const R& b) {
  return select(a < b, b, a);
}

/// A pivot below this share of the terms that made it is rounding: its unknown depends on earlier ones and becomes
/// zero.
constexpr double least_pivot = 1e-6;

/// True if R is one number, so that compilers handle rows of a block by whole registers. Where R has lanes, what is
/// left of the diagonal is not computed.
template <class R>
constexpr bool is_one_number = std::is_floating_point_v<R>;

/// The factors L D L^T of a block: L^T above the diagonal of the matrix, and 1 / D, which is 0 where an unknown is
/// lost.
template <class R>
struct Pivots {
  R inverse[most_of_block];
};

/// Factorises a block in place, row after row: each row takes away what the rows before it leave in it.
template <int width, class R>
PLIANT_HD void factorise(R* m, int size, Pivots<R>& pivots) {
  R whole[width], scaled[width][width];
  for (int i = 0; i < width; ++i) whole[i] = i < size ? larger(m[i * width + i], -m[i * width + i]) : R(0);
  for (int k = 0; k < size; ++k) {
    const int from = is_one_number<R> ? 0 : k;
    R row[width];
    for (int i = from; i < width; ++i) row[i] = m[k * width + i];
    for (int j = 0; j < k; ++j) {
      const R factor = m[j * width + k];
      for (int i = from; i < width; ++i) row[i] = row[i] - scaled[j][i] * factor;
    }
    const R pivot = row[k];
    const auto is_kept = larger(pivot, -pivot) > R(least_pivot) * whole[k];
    const R inverse = select(is_kept, R(1) / pivot, R(0));
    pivots.inverse[k] = inverse;
    for (int i = from; i < width; ++i) {
      const R before = select(is_kept, row[i], R(0)), after = row[i] * inverse, term = after * before;
      scaled[k][i] = before;
      m[k * width + i] = after;
      whole[i] = larger(whole[i], larger(term, -term));
    }
  }
}

/// Replaces right-hand sides, one a column, by their solutions, with the factors of a block.
template <int columns, int width, class R>
PLIANT_HD void solve_columns(const R* m, const Pivots<R>& pivots, int size, R* b) {
  for (int i = 1; i < size; ++i) {
    R row[columns];
    for (int c = 0; c < columns; ++c) row[c] = b[i * columns + c];
    for (int j = 0; j < i; ++j)
      for (int c = 0; c < columns; ++c) row[c] = row[c] - m[j * width + i] * b[j * columns + c];
    for (int c = 0; c < columns; ++c) b[i * columns + c] = row[c];
  }
  for (int i = size; i-- > 0;) {
    R row[columns];
    for (int c = 0; c < columns; ++c) row[c] = b[i * columns + c] * pivots.inverse[i];
    for (int j = i + 1; j < size; ++j)
      for (int c = 0; c < columns; ++c) row[c] = row[c] - m[i * width + j] * b[j * columns + c];
    for (int c = 0; c < columns; ++c) b[i * columns + c] = row[c];
  }
}

/// What eliminating a block leaves in its parent: the matrix and right-hand side of the parent.
template <class R>
struct Parent {
  R *m, *x;
  int size;
};

/// Subtracts what eliminating a block leaves in its parent, given the coupling before and after it was solved.
template <int width, class R>
PLIANT_HD void reduce(const R* coupling, const R* solved, const R* x, int size, const Parent<R>& parent) {
  for (int c = 0; c < parent.size; ++c) {
    const int from = is_one_number<R> ? 0 : c;
    R row[width], right = parent.x[c];
    for (int d = from; d < width; ++d) row[d] = parent.m[c * width + d];
    for (int r = 0; r < size; ++r) {
      const R factor = coupling[r * width + c];
      right = right - factor * x[r];
      for (int d = from; d < width; ++d) row[d] = row[d] - factor * solved[r * width + d];
    }
    for (int d = from; d < width; ++d) parent.m[c * width + d] = row[d];
    parent.x[c] = right;
  }
}

/// The numbers of a block.
template <class R>
struct Block {
  R* m;          ///< its matrix
  R* to_parent;  ///< rows of this block, columns of its parent
  R* x;          ///< the right-hand side, then the solution
};

/// Eliminates a block of `size` unknowns. `parent.m` is null if it is a root.
template <int width, class R>
PLIANT_HD void eliminate(const Block<R>& block, int size, const Parent<R>& parent) {
  Pivots<R> pivots;
  factorise<width>(block.m, size, pivots);
  solve_columns<1, width>(block.m, pivots, size, block.x);
  if (parent.m == nullptr) return;
  R coupling[most_of_block * width];
  for (int i = 0; i < size * width; ++i) coupling[i] = block.to_parent[i];
  solve_columns<width, width>(block.m, pivots, size, block.to_parent);
  reduce<width>(coupling, block.to_parent, block.x, size, parent);
}

/// Completes the solution of an eliminated block by that of its parent.
template <int width, class R>
PLIANT_HD void substitute(const Block<R>& block, int size, const R* x_of_parent, int size_of_parent) {
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size_of_parent; ++c) block.x[r] = block.x[r] - block.to_parent[r * width + c] * x_of_parent[c];
}

}  // namespace block_tree

template <class R>
void BlockTree<R>::reset(std::vector<Block> blocks) {
  blocks_ = std::move(blocks);
  int largest = 1, count = 0;
  for (const Block& block : blocks_) largest = std::max(largest, block.size);
  stride_ = largest <= 4 ? 4 : largest <= 8 ? 8 : most_of_block;
  first_.clear();
  for (const Block& block : blocks_) {
    first_.push_back(count);
    count += (2 * block.size + 1) * stride_;
  }
  values_.assign(static_cast<std::size_t>(count), R(0));
}

template <class R>
template <int width>
void BlockTree<R>::solve_rows() {
  const auto numbers = [&](std::size_t n) { return block_tree::Block<R>{diagonal(n), to_parent(n), x(n)}; };
  for (std::size_t n = 0; n < blocks_.size(); ++n) {
    const auto above = static_cast<std::size_t>(blocks_[n].parent);
    const block_tree::Parent<R> parent = blocks_[n].parent < 0
                                             ? block_tree::Parent<R>{nullptr, nullptr, 0}
                                             : block_tree::Parent<R>{diagonal(above), x(above), blocks_[above].size};
    block_tree::eliminate<width>(numbers(n), blocks_[n].size, parent);
  }
  for (std::size_t n = blocks_.size(); n-- > 0;) {
    if (blocks_[n].parent < 0) continue;
    const auto above = static_cast<std::size_t>(blocks_[n].parent);
    block_tree::substitute<width>(numbers(n), blocks_[n].size, x(above), blocks_[above].size);
  }
}

template <class R>
void BlockTree<R>::solve() {
  if (stride_ == 4) return solve_rows<4>();
  if (stride_ == 8) return solve_rows<8>();
  solve_rows<16>();
}

}  // namespace pliant
