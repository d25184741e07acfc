// Pairs of primitives as stencils of four particles, vertex-triangle or edge-edge, and their distance.
#pragma once

#include <array>
#include <cstdint>

#include "model/substep.h"
#include "pliant/vec3.h"

namespace pliant {

/// Four particles: the first `first_side` are the corners of one primitive, the rest those of the other.
struct PairStencil {
  std::array<std::int32_t, 4> vertex{};
  int first_side = 1;  ///< number of vertices on the first side; 1: vertex-triangle, 2: edge-edge
};

/// The closest points of two primitives and their distance.
struct PairDistance {
  std::array<double, 4> weight{};  ///< weights of the particles: they sum to 1 on the first side and to -1 on the other
  Vec3d normal{};                  ///< unit vector from the second primitive to the first; zero if they touch
  double distance = 0;             ///< distance of the closest points [m]
};

/// Computes the distance in double precision from float positions; either primitive may be degenerate.
PairDistance pair_distance(const PairStencil& pair, const Record* positions);

/// Sixteen pairs of one kind, stored by corner; unused lanes hold any valid particles.
struct alignas(64) PairStencils {
  std::int32_t vertex[4][16];
};

/// The distances of sixteen pairs of one kind, in float. Positions are relative to each pair's first particle, so
/// rounding errors scale with the pair's size. For nearly parallel edges and sliver triangles the closest points in
/// float can be wrong: `distance` may then exceed the true distance, `at_least` never does.
struct PairBatch {
  alignas(64) float distance[16];
  alignas(64) float at_least[16];  ///< lower bound of the true distance, >= 0 [m]
  alignas(64) float weight[4][16];
  alignas(64) float normal[3][16];
};
void pair_distances(const PairStencil* pairs, int count, const Record* positions, PairBatch& out);

/// The contact parameters of two surfaces.
struct PairMaterial {
  float thickness = 0;  ///< minimum distance of both surfaces [m]
  float static_friction = 0, kinetic_friction = 0;
  float restitution = 0;  ///< coefficient of restitution, 0..1 [-]
};

}  // namespace pliant
