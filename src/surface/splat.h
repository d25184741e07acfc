// A particle's kernel, the lists that say where kernels are, and boxes.
#pragma once

#include "math/vector.h"

namespace pliant::surface {

/// The kernel weight max(0, 1 - q)^3 with q = d A d, where d is the vector from the centre. One cache line.
struct alignas(64) Splat {
  Vec3f centre;
  float weight;                  ///< so that the kernel's integral is spacing^3
  float xx, yy, zz, xy, xz, yz;  ///< A [1/m^2]
  float unused[2];
  Vec3f reach;  ///< half the size of the ellipsoid's box [m]
  float unused_too;
};

/// A box in space [m].
struct Box {
  Vec3f low, high;
};

// Rows have a value for each number, and sixteen more that may be read.

/// Where particles and their kernels are [m].
template <class Float>
struct PlaceRows {
  Float *x, *y, *z;
};

/// How far kernels reach.
template <class Float>
struct SizeRows {
  Float *per_x, *per_y, *per_z;  ///< 1 / reach [1/m]
  Float* widest;  ///< the ellipsoid is within the one along the axes with the reach times the root of this
};

template <class Float>
struct SplatRows {
  PlaceRows<Float> at;
  SizeRows<Float> size;
};

}  // namespace pliant::surface
