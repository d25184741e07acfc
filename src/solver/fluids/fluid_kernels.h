// The passes over the particles of a liquid, one table for each instruction set level as in solver/kernels.h. All
// tables give the same bits: a particle adds its neighbours one after another.
#pragma once

#include <cstdint>

#include "collision/neighbours/neighbour_group.h"
#include "geometry/shapes.h"
#include "math/levels.h"
#include "math/quat.h"
#include "pliant/state.h"
#include "solver/fluids/fluid_law.h"

namespace pliant {

/// Arrays by slot (collision/neighbours/neighbour_lists.h). Over fifteen members: what the passes read and write.
struct FluidArrays {
  FluidLaw law;
  float relaxation = 0;  ///< share of a correction that is made
  float softness = 0;    ///< compliance over the square of the substep [1/m^2]

  const Record* places = nullptr;    ///< predicted [m]
  Record* weighted = nullptr;        ///< places, and in w what the multiplier changes
  float* multipliers = nullptr;      ///< of the substep
  const Record* walls = nullptr;     ///< gradient of the share of walls in the density [1/m], and that share [-]
  const char* has_walls = nullptr;   ///< for each group, 1 if any of its `walls` is not zero
  const float* squares = nullptr;    ///< what bodies add to the squared gradients [1/m^2]; null: nothing
  float* densities = nullptr;        ///< over that at rest [-]
  const float* lightness = nullptr;  ///< density of the lightest liquid over that of the particle; null: all are equal
  const std::int32_t* points = nullptr;  ///< of each slot: its particle
  Record* displacements = nullptr;       ///< by particle [m]
  int slots = 0;
};

/// The most colliders and solids that bound one particle.
inline constexpr int most_walls = 16;

/// A collider or solid at the substep's end.
struct Wall {
  LocalShape shape;
  Pose<float> pose;
  float thickness = 0;         ///< [m]
  Vec3f* gradients = nullptr;  ///< of each slot: gradient of the wall's share in its density [1/m]; null: not wanted
  int* touched = nullptr;      ///< likewise: to how many slots the wall is near is added
};

/// The walls near sixteen slots.
struct WallQuery {
  FluidLaw law;
  Wall walls[most_walls];
  int count = 0;
  const Record* places = nullptr;  ///< of the slots [m]
  Record* shares = nullptr;        ///< see FluidArrays::walls
};

struct FluidKernels {
  /// The density of a group's particles, and how far their multipliers change.
  void (*find_multipliers)(const FluidArrays& arrays, const NeighbourGroup& group, int number);
  /// Moves a group's particles by these changes and those of their neighbours.
  void (*move)(const FluidArrays& arrays, const NeighbourGroup& group, int number);
  /// The share of walls in the density of a group's particles.
  void (*measure_walls)(const WallQuery& query);
};

PLIANT_DECLARE_LEVELS(FluidKernels, fluid_kernels)
const FluidKernels& fluid_kernels_sequential();

}  // namespace pliant
