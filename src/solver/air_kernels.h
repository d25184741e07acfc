// The air's forces on surfaces: SIMD kernels for each instruction set level, and scalar ones with the same bits.
#pragma once

#include "math/levels.h"
#include "pliant/state.h"
#include "pliant/vec3.h"

namespace pliant {

/// An object in the air. Arrays of records begin with its first particle.
struct AirArguments {
  const int* triangles;               ///< vertices, three for each triangle
  const int *corner_begin, *corners;  ///< triangle corners at each particle: Surface::corner_begin and corners
  const Record* positions;
  Record* velocities;
  Record* forces;  ///< force on each triangle [N]; room for a multiple of `air_batch`
  Vec3f air;       ///< air velocity [m/s]
  Vec3f gravity;   ///< gravity that the velocities of dynamic particles do not include yet [m/s]
  float h, air_density, drag, lift;
};

/// Triangles of which forces are stored at a time.
inline constexpr int air_batch = 16;

struct AirKernels {
  /// Computes the forces on triangles [first, last). `first` is a multiple of `air_batch`. Forces beyond the last one,
  /// up to the next multiple, are undefined.
  void (*find_forces)(const AirArguments& arguments, int first, int last);
  /// Adds h f / m to the velocities of particles [first, last), where f is a third of the force on each of their
  /// triangles, added in ascending order.
  void (*apply)(const AirArguments& arguments, int first, int last);
};

PLIANT_DECLARE_LEVELS(AirKernels, air_kernels)
const AirKernels& air_kernels_sequential();

}  // namespace pliant
