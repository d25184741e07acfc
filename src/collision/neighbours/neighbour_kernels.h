// The inner loop of the search for neighbours, one table for each instruction set level as in solver/kernels.h. Lists
// are whole numbers in ascending order, so all tables give the same.
#pragma once

#include <cstdint>

#include "collision/neighbours/neighbour_group.h"
#include "math/levels.h"
#include "math/vector.h"

namespace pliant {

inline constexpr int most_neighbours = 256;   ///< of a point; more are left out, and counted
inline constexpr int most_candidates = 2048;  ///< that are compared at a time
/// From one list to the next: a power of two would put all on the same cache lines.
inline constexpr int neighbour_stride = most_neighbours + 16;

/// Finds the neighbours of slots [first, last), at most sixteen that lie together.
struct NeighbourQuery {
  const float *x, *y, *z;  ///< places by slot [m]; sixteen more than there are slots may be read
  float reach;             ///< largest distance of a neighbour [m]
  Vec3f low, high;         ///< the box of these slots
  const SlotRange* ranges;
  int range_count;  ///< ranges of slots that have all neighbours, ascending
  std::int32_t first, last;
};

/// Lists and candidates have room for one register more, because whole registers are stored.
struct NeighbourScratch {
  alignas(64) std::int32_t found[neighbour_lanes][neighbour_stride];  ///< of each lane: slots, ascending
  std::int32_t candidate[most_candidates + 16];
  float x[most_candidates + 16], y[most_candidates + 16], z[most_candidates + 16];
  std::int32_t count[neighbour_lanes];     ///< of `found`
  std::int32_t has_more[neighbour_lanes];  ///< 1 if a slot has more neighbours than fit
};

struct NeighbourKernels {
  /// Appends to `found` and `count` from lane `lane` on.
  void (*find)(const NeighbourQuery& query, int lane, NeighbourScratch& scratch);
  /// Writes the k-th neighbours of all lanes side by side, for k below `rows`, and up to three rows more. Short lists
  /// end in `nobody`.
  void (*write_rows)(NeighbourScratch& scratch, std::int32_t nobody, int rows, std::int32_t* to);
};

PLIANT_DECLARE_LEVELS(NeighbourKernels, neighbour_kernels)
const NeighbourKernels& neighbour_kernels_sequential();

}  // namespace pliant
