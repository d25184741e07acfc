// What the files of PairSystem share: how bounds allow for rounding, and where particles go.
#pragma once

#include "collision/pairs.h"
#include "math/vector.h"

namespace pliant {

/// Nearer than any distance: to be measured before anything else.
inline constexpr float not_measured = -1e30f;
/// Bounds of distances are floats: this much is allowed for their rounding.
inline constexpr float bound_slack = 1.0001f;
/// Sums of moves that are taken off again later are rounded some ten times.
inline constexpr float sum_slack = 1 - 1e-6f;
/// One rounding of a float, as a share of it.
inline constexpr float rounding = 6e-8f;

/// Two numbers as one key that sorts like the pair.
inline std::uint64_t key_of(int a, int b) { return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b); }

inline Vec3f end_of(const PairParticles& particles, std::size_t i, float times = 1) {
  const Record &x = particles.positions[i], &d = particles.displacements[i];
  return {x.x + d.x * times, x.y + d.y * times, x.z + d.z * times};
}

/// By how much a position changes: not quite by the displacement, which it can't hold.
inline Vec3f move_of(const PairParticles& particles, std::size_t i) {
  return end_of(particles, i) - end_of(particles, i, 0);
}

}  // namespace pliant
