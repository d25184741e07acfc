// Two primitives as four particles: a vertex and a triangle, or two edges; how far they are apart.
#pragma once

#include <array>
#include <cstdint>

#include "model/substep.h"
#include "pliant/vec3.h"

namespace pliant {

/// Four particles, the first `first_side` of them one primitive, the others the other.
struct PairStencil {
  std::array<std::int32_t, 4> vertex{};
  int first_side = 1;  ///< 1: a vertex and a triangle; 2: two edges
};

/// Where two primitives are closest.
struct PairDistance {
  std::array<double, 4> weight{};  ///< of each particle: adding up to 1 on the first side, to -1 on the other
  Vec3d normal{};                  ///< unit, from the second to the first; zero where they touch
  double distance = 0;             ///< [m]
};

/// In double, from float positions; each primitive may be degenerate.
PairDistance pair_distance(const PairStencil& pair, const Record* positions);

/// Sixteen pairs of one kind, corner by corner; all sixteen name particles, those that are not asked for any.
struct alignas(64) PairStencils {
  std::int32_t vertex[4][16];
};

/// Sixteen pairs of one kind at once, in float. Places are relative to each pair's first particle, so that rounding is that of the
/// pair's own size. Where edges are nearly parallel or a triangle is a sliver, the closest points of a float are others:
/// `distance` may be longer than the true one, `at_least` is not.
struct PairBatch {
  alignas(64) float distance[16];
  alignas(64) float at_least[16];  ///< a lower bound of the true distance, 0 or more [m]
  alignas(64) float weight[4][16];
  alignas(64) float normal[3][16];
};
void pair_distances(const PairStencil* pairs, int count, const Record* positions, PairBatch& out);

/// What two surfaces are to one another.
struct PairMaterial {
  float thickness = 0;  ///< distance kept [m]
  float static_friction = 0, kinetic_friction = 0;
  float restitution = 0;  ///< 0..1 [-]
};

}  // namespace pliant
