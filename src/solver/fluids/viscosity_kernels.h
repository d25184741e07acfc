// The passes of viscosity over pairs of neighbours, one table for each instruction set level as in solver/kernels.h.
// All tables give the same bits: a particle adds its neighbours one after another.
#pragma once

#include <cstdint>

#include "collision/neighbours/neighbour_group.h"
#include "math/levels.h"
#include "pliant/state.h"
#include "solver/fluids/viscosity_law.h"

namespace pliant {

/// Arrays by slot (collision/neighbours/neighbour_lists.h).
struct ViscosityArrays {
  ViscosityLaw law;
  float scale = 0;                     ///< of the law, times the substep, times the viscosity if all have one
  const Record* places = nullptr;      ///< [m]
  const float* viscosities = nullptr;  ///< [Pa s]; null: `scale` has it
  const Record* motions = nullptr;     ///< displacements in the substep [m]
  Record* forces = nullptr;            ///< on each particle, times the square of the substep [kg m]
};

struct ViscosityKernels {
  /// Sets NeighbourGroup::factors to the resistance of each pair over its squared length.
  void (*find_factors)(const ViscosityArrays& arrays, const NeighbourGroup& group, int number);
  /// The resistance of neighbours to the motions of a group's particles.
  void (*resist)(const ViscosityArrays& arrays, const NeighbourGroup& group, int number);
};

PLIANT_DECLARE_LEVELS(ViscosityKernels, viscosity_kernels)
const ViscosityKernels& viscosity_kernels_sequential();

}  // namespace pliant
