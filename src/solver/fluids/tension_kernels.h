// The passes of surface tension over pairs of neighbours, one table for each instruction set level as in
// solver/kernels.h. All tables give the same bits: a particle adds its neighbours one after another.
#pragma once

#include <cstdint>

#include "collision/neighbours/neighbour_group.h"
#include "math/levels.h"
#include "pliant/state.h"
#include "solver/fluids/tension_law.h"

namespace pliant {

/// Arrays by slot (collision/neighbours/neighbour_lists.h).
struct TensionArrays {
  TensionLaw law;
  const Record* places = nullptr;   ///< [m]
  const float* tensions = nullptr;  ///< [N/m]
  const float* walls = nullptr;     ///< what walls add to the count [-]; null: nothing
  Record* lacking = nullptr;        ///< places, and in w how much the energy falls with the count [J]
  Record* forces = nullptr;         ///< on each particle [N]
};

struct TensionKernels {
  /// Sets `lacking` of a group's particles.
  void (*count)(const TensionArrays& arrays, const NeighbourGroup& group, int number);
  /// Sets the forces on a group's particles.
  void (*pull)(const TensionArrays& arrays, const NeighbourGroup& group, int number);
};

PLIANT_DECLARE_LEVELS(TensionKernels, tension_kernels)
const TensionKernels& tension_kernels_sequential();

}  // namespace pliant
