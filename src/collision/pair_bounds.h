// What the files of PairSystem share: how bounds allow for rounding, and where particles go.
#pragma once

#include "collision/pairs.h"
#include "math/vector.h"

namespace pliant {

/// Nearer than any distance: to be measured before anything else.
inline constexpr float not_measured = -1e30f;
/// Farther than any distance.
inline constexpr float out_of_reach = 1e30f;
/// Bounds are sums of floats: pairs are dismissed only when they are out of reach by more than this.
inline constexpr float cull_slack = 1.0001f;
/// Sums of moves that are taken off again later are rounded some ten times.
inline constexpr float sum_slack = 1 - 1e-6f;
/// Places as seen by one who drifts along are rounded this often, at most.
inline constexpr float place_roundings = 16;
/// One rounding of a float, as a share of it.
inline constexpr float rounding = 6e-8f;

/// One of sixteen pairs.
inline PairStencil stencil_at(const PairStencils& pairs, int lane, bool of_vertices) {
  return {{pairs.vertex[0][lane], pairs.vertex[1][lane], pairs.vertex[2][lane], pairs.vertex[3][lane]},
          of_vertices ? 1 : 2};
}

inline Vec3f end_of(const PairParticles& particles, std::size_t i, float times = 1) {
  const Record &x = particles.positions[i], &d = particles.displacements[i];
  return {x.x + d.x * times, x.y + d.y * times, x.z + d.z * times};
}

/// By how much a position changes: not quite by the displacement, which it can't hold.
inline Vec3f move_of(const PairParticles& particles, std::size_t i) {
  return end_of(particles, i) - end_of(particles, i, 0);
}

}  // namespace pliant
