// The hierarchy of the multigrid correction (solver/sweeps/multigrid.h): particles gathered into groups of up to four, those
// into groups again, until sixteen are left. Made once, from the graph of distance constraints alone; what moves fills in
// the numbers.
//
// A level is a sparse matrix of 3 x 3 blocks by rows, laid out for sixteen lanes: sixteen rows that follow one another are a
// batch, row 16 b + 4 (l % 4) + l / 4 being lane l of batch b (math/wide.h), and a slot holds one neighbour of each. Rows of a
// batch with fewer neighbours than others name themselves, which adds nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// Groups of one level that become rows of the next: at most so many.
inline constexpr int largest_group = 4;
/// Where the hierarchy ends.
inline constexpr int coarsest_rows = 16;

struct MultigridLevel {
  int rows = 0;
  std::vector<std::int32_t> first_slot;  ///< of each batch; one more at the end
  std::vector<std::int32_t> column;      ///< sixteen a slot: the neighbour, or the row itself where there is none

  // The finest level: springs. Zero stiffness where a lane has no neighbour.
  AlignedVector<float> stiffness, rest_length;  ///< sixteen a slot [N/m], [m]

  // Every other: what of the finer level each block is the sum of, as 16 x slot + lane there; lane l of slot s has
  // sources[source_begin[16 s + l]] on. And what is anchored: blocks between a row and something that can't move.
  std::vector<std::int32_t> source_begin, sources;
  std::vector<std::int32_t> anchor_begin, anchors;  ///< by 16 x batch + lane
  std::vector<std::int32_t> children;  ///< by batch, largest_group x 16: rows of the finer level, or its `nothing`

  std::vector<std::int32_t> parent;  ///< by 16 x batch + lane: row of the next level, or its `nothing`

  PLIANT_HD int batches() const { return (rows + batch_width - 1) / batch_width; }
  int slots() const { return first_slot.empty() ? 0 : first_slot.back(); }
  /// The number of a record that is always zero: after the last batch's.
  PLIANT_HD int nothing() const { return batches() * batch_width; }
};

/// Empty where an object has no distance constraint with a rest length.
struct Multigrid {
  std::vector<MultigridLevel> levels;
  std::vector<std::int32_t> piece;  ///< of each particle: number of what springs join it to, or -1 where it can't move
  std::vector<std::int32_t> coarsest_piece;  ///< of each row of the last level, likewise
  int pieces = 0;
  float edge_length = 0;               ///< of all springs at rest, the mean [m]
  std::vector<float> stiffness_limit;  ///< of the springs at each particle: an edge has the larger of its ends' [N/m]
};

/// Row of a lane of a batch, and back.
PLIANT_HD int row_of(int batch, int lane) { return batch * batch_width + 4 * (lane % 4) + lane / 4; }
PLIANT_HD int lane_place(int row) {
  const int within = row % batch_width;
  return row - within + within / 4 + 4 * (within % 4);
}

/// The stiffest spring that a distance constraint counts as near particle ends with these limits, K = 1 / alpha below it.
PLIANT_HD float spring_stiffness(float compliance, float limit) { return compliance * limit > 1 ? 1 / compliance : limit; }

/// `positions` of the particles in storage order, w their inverse mass; `gravity` is the magnitude [m/s^2].
Multigrid build_multigrid(const std::vector<ConstraintList>& lists, const std::vector<Record>& positions, float gravity);

}  // namespace pliant
