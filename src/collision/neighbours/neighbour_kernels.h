// The inner loop of the search for neighbours, one table for each instruction set level as in solver/kernels.h. Lists are whole
// numbers in ascending order, so all tables give the same.
#pragma once

#include <cstdint>

#include "collision/neighbours/neighbour_group.h"
#include "math/levels.h"

namespace pliant {

inline constexpr int most_neighbours = 256;      ///< of a point; more are left out, and counted
inline constexpr int most_candidates = 1 << 13;  ///< of sixteen slots that lie together; likewise

/// Finds the neighbours of slots [first, last), at most sixteen that lie together.
struct NeighbourQuery {
  const float *x, *y, *z;  ///< places by slot [m]; sixteen more than there are slots may be read
  float reach;             ///< largest distance of a neighbour [m]
  const SlotRange* ranges;
  int range_count;  ///< ranges of slots that have all neighbours, ascending
  std::int32_t first, last;
};

struct NeighbourScratch {
  std::int32_t candidate[most_candidates + 16];
  float x[most_candidates + 16], y[most_candidates + 16], z[most_candidates + 16];
  std::int32_t found[neighbour_lanes][most_neighbours];  ///< of each lane: slots, ascending
  std::int32_t count[neighbour_lanes];                   ///< of `found`
  std::int32_t left_out;                                 ///< how many slots have more than fit
};

struct NeighbourKernels {
  /// Fills `found` and `count` from lane `lane` on.
  void (*find)(const NeighbourQuery& query, int lane, NeighbourScratch& scratch);
};

PLIANT_DECLARE_LEVELS(NeighbourKernels, neighbour_kernels)
const NeighbourKernels& neighbour_kernels_sequential();

}  // namespace pliant
