// The levels of the multigrid correction (solver/sweeps/multigrid.h). Particles are aggregated into groups of up to
// four, repeatedly, until sixteen rows remain. The levels depend on the graph of distance constraints alone and are
// built once; each solve computes their numerical values.
//
// A level is a sparse block matrix of 3 x 3 blocks by rows, in layout for sixteen lanes. Sixteen consecutive rows are a
// batch: row 16 b + 4 (l % 4) + l / 4 is lane l of batch b (math/wide.h). A slot holds one neighbour of each row;
// missing neighbours refer to the row itself, which adds nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// Largest number of rows that form one row of the next level.
inline constexpr int largest_group = 4;
/// Number of rows at which coarsening ends.
inline constexpr int coarsest_rows = 16;

struct MultigridLevel {
  int rows = 0;
  std::vector<std::int32_t> first_slot;  ///< for each batch, its first slot; the total number of slots at the end
  std::vector<std::int32_t> column;      ///< sixteen per slot: the neighbour, or the row itself if there is none

  // Finest level only: springs. Their stiffness is zero in lanes without a neighbour.
  AlignedVector<float> stiffness, rest_length;  ///< for each slot, sixteen values [N/m] and [m]

  // Coarser levels only: each block is a sum of blocks of the finer level. Slot s adds rounds first_round[s] to
  // first_round[s + 1]; a round has for each lane the finer block's row_of(slot, lane), or the finer level's
  // no_block(). Anchors are blocks between a row and a fixed particle.
  std::vector<std::int32_t> first_round, sources;
  /// Blocks to fixed particles: list starts by 16 x batch + lane; lists.
  std::vector<std::int32_t> anchor_begin, anchors;
  std::vector<std::int32_t> children;  ///< largest_group x 16 per batch: rows of the finer level, or its nothing()

  std::vector<std::int32_t> parent;  ///< by 16 x batch + lane: row of the next level, or its nothing()

  PLIANT_HD int batches() const { return (rows + batch_width - 1) / batch_width; }
  int slots() const { return first_slot.empty() ? 0 : first_slot.back(); }
  /// The index of a record that is always zero; it follows the last batch.
  PLIANT_HD int nothing() const { return batches() * batch_width; }
  /// The place of a block that is always zero; it follows the last slot.
  int no_block() const { return slots() * batch_width; }
};

/// The levels of one object. There are none if it has no distance constraint with a positive rest length.
struct Multigrid {
  std::vector<MultigridLevel> levels;
  std::vector<std::int32_t> piece;  ///< for each particle, index of its connected component of springs; -1: none
  std::vector<std::int32_t> coarsest_piece;  ///< connected component of each row of the last level; -1: none
  int pieces = 0;
  /// Batches of the finest level in which a row has a neighbour of another component, such as a fixed particle.
  std::vector<std::int32_t> border_batches;
  float edge_length = 0;               ///< mean rest length of all springs [m]
  std::vector<float> stiffness_limit;  ///< for each particle; an edge has the larger limit of its ends [N/m]
};

/// row_of returns the matrix row in a lane of a batch; lane_place is the inverse and returns 16 x batch + lane.
PLIANT_HD int row_of(int batch, int lane) { return batch * batch_width + 4 * (lane % 4) + lane / 4; }
PLIANT_HD int lane_place(int row) {
  const int within = row % batch_width;
  return row - within + within / 4 + 4 * (within % 4);
}

/// The spring stiffness of a distance constraint [N/m]: 1 / compliance, at most `limit`.
PLIANT_HD float spring_stiffness(float compliance, float limit) {
  return compliance * limit > 1 ? 1 / compliance : limit;
}

/// Builds the levels. `positions`: in storage order, inverse mass in w; `gravity`: its magnitude [m/s^2].
Multigrid build_multigrid(const std::vector<ConstraintList>& lists, const std::vector<Record>& positions,
                          float gravity);

}  // namespace pliant
