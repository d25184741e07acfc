// The kernel of each particle: an ellipsoid that is flat where the liquid is.
//
// Yu and Turk (2013) take the ellipsoid from the covariance C of a particle's neighbours, by a decomposition whose eigenvalues they
// clamp. Here its squared radii are those of a C + b I, with constants a and b. So small radii are bounded below without a
// decomposition, a particle without neighbours (C = 0) has a ball, and nothing jumps when a neighbour comes or goes.
#pragma once

#include <vector>

#include "surface/particle_cells.h"

namespace pliant::surface {

/// The kernel weight max(0, 1 - q)^3 with q = d A d, where d is the vector from the centre.
struct Splat {
  Vec3f centre;
  float xx, yy, zz, xy, xz, yz;  ///< A [1/m^2]
  float weight;                  ///< so that the kernel's integral is spacing^3
  Vec3f reach;                   ///< half the size of the ellipsoid's box [m]
};

/// A box in space [m].
struct Box {
  Vec3f low, high;
};

struct Splats {
  std::vector<Splat> all;   ///< in the order of the cells
  std::vector<Box> bounds;  ///< of the splats of each cell
  float reach = 0;          ///< the largest of all splats along an axis [m]
};

Splats make_splats(const ParticleCells& cells, float spacing, bool anisotropic, Executor& executor);

}  // namespace pliant::surface
