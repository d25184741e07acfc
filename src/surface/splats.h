// The kernel of each particle: an ellipsoid that is flat where the liquid is (splat_formula.h).
#pragma once

#include <vector>

#include "surface/particle_cells.h"
#include "surface/surface_kernels.h"

namespace pliant::surface {

struct Splats {
  std::vector<Splat> all;                          ///< in the order of the cells
  std::vector<Box> bounds;                         ///< of the splats of each cell
  std::vector<float> per_x, per_y, per_z, widest;  ///< as in SplatRows, and sixteen more
};

/// The rows of the kernels of these particles.
SplatRows<const float> rows_of(const ParticleCells& cells, const Splats& splats);

Splats make_splats(const ParticleCells& cells, float spacing, bool anisotropic, Executor& executor,
                   const SurfaceKernels& kernels = best_kernels());

}  // namespace pliant::surface
