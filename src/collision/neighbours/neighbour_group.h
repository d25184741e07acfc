// Slots: the places of points in the order of cells (collision/neighbours/cell_order.h).
#pragma once

#include <cstdint>

namespace pliant {

/// Consecutive slots, half-open.
struct SlotRange {
  std::int32_t first = 0, last = 0;
};

inline constexpr int neighbour_lanes = 16;  ///< slots whose lists lie side by side

/// The lists of sixteen consecutive slots.
struct NeighbourGroup {
  const std::int32_t* slots = nullptr;  ///< `rows` times sixteen; short lists end in NeighbourLists::nobody()
  float* factors = nullptr;             ///< as many, for what a pass keeps for the next one; null if nothing is kept
  int rows = 0;                         ///< length of the longest list
};

}  // namespace pliant
