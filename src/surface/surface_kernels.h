// The inner loops of the surface in SIMD lanes, one table for each instruction set level as in solver/kernels.h. All
// give the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "math/levels.h"
#include "pliant/state.h"
#include "surface/splat.h"

namespace pliant::surface {

/// Particles [first, last) in the order of cells.
struct ParticleRange {
  int first, last;
};

/// Moments of the neighbours of a particle, weighted by 1 - r^2 / radius^2, about the particle itself.
struct Moments {
  Record first;   ///< x, y, z: sums of the neighbours' places relative to it [m]; w: the sum of weights
  Record second;  ///< sums of xx, yy, zz and xy [m^2]
  Record third;   ///< of xz and yz
};

inline constexpr int group_size = 16;         ///< most particles that share their candidates
inline constexpr int most_candidates = 1024;  ///< that are compared at a time; a multiple of sixteen

/// Asks for the moments of particles [first, last), at most group_size, that lie together.
struct MomentQuery {
  PlaceRows<const float> at;
  const ParticleRange* around;
  int range_count;  ///< these ranges have all neighbours
  int first, last;
  float radius;  ///< of neighbours [m]
};

struct MomentScratch {
  alignas(64) float x[most_candidates + 32], y[most_candidates + 32], z[most_candidates + 32];
};

/// What kernels follow from.
struct SplatRule {
  float spacing;
  bool anisotropic;
};

/// The nodes of a brick: `side` of them along each axis from a corner. Centres count from `origin`.
inline constexpr int brick_side = 4;
inline constexpr int brick_nodes = brick_side * brick_side * brick_side;
struct BrickPlace {
  Vec3f origin;      ///< of the brick's block [m]
  Vec3f first_node;  ///< the brick's, from there, in cells
  float cell;        ///< [m]
  float level;       ///< nodes with more are inside
};

struct SurfaceKernels {
  /// Finds moments, the first of which go to *to.
  void (*find_moments)(const MomentQuery& query, MomentScratch& scratch, Moments* to);
  /// Makes the kernels of `count` particles.
  void (*make_splats)(const SplatRule& rule, const Moments* moments, int count, const PlaceRows<const float>& at,
                      const SizeRows<float>& sizes, Splat* to);
  /// Appends rows of kernels that reach a box, with their numbers; returns how many there are now. There must be room
  /// for sixteen more.
  int (*gather)(const SplatRows<const float>& from, const ParticleRange& range, const Box& box, int count,
                const SplatRows<float>& to, int* numbers);
  /// Lists the numbers of the first `count` kernels that reach a box, and returns how many do.
  int (*choose)(const SplatRows<const float>& from, const int* numbers, int count, const Box& box, int* to);
  /// Sums kernels at the nodes of a brick, by z, y and x; returns a bit for each node that is inside.
  std::uint64_t (*sum)(const Splat* splats, const int* numbers, int count, const BrickPlace& place, float* to);
};

/// The widest table that this machine runs.
const SurfaceKernels& best_kernels();
/// The tables of all levels that this machine runs, widest first.
std::vector<const SurfaceKernels*> all_kernels();

}  // namespace pliant::surface

namespace pliant {

PLIANT_DECLARE_LEVELS(surface::SurfaceKernels, surface_kernels)

}  // namespace pliant
