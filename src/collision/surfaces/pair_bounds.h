// What the files of PairSystem share: how bounds allow for rounding, and where particles go.
#pragma once

#include "collision/surfaces/pairs.h"
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

/// What the filter keeps, as a share of the thickness; and at least so many roundings of the two clusters' positions.
inline constexpr float least_share = 0.05f, least_roundings = 32;

/// One of sixteen pairs.
inline PairStencil stencil_at(const PairStencils& pairs, int lane, bool of_vertices) {
  return {{pairs.vertex[0][lane], pairs.vertex[1][lane], pairs.vertex[2][lane], pairs.vertex[3][lane]},
          of_vertices ? 1 : 2};
}

inline void put(PairStencils& pairs, std::size_t lane, const std::array<std::int32_t, 4>& vertex) {
  for (std::size_t k = 0; k < 4; ++k) pairs.vertex[k][lane] = vertex[k];
}

inline const PairMaterial& PairSystem::material(const Between& clusters) const {
  const int a = model_.cluster_body[clusters.first], b = model_.cluster_body[clusters.second];
  return model_.materials[static_cast<std::size_t>(a) * model_.bodies + b];
}

/// What the filter keeps between two clusters [m].
inline float PairSystem::least_of(const Between& clusters) const {
  const float extent = max(motions_[clusters.first].extent, motions_[clusters.second].extent);
  return max(least_share * material(clusters).thickness, least_roundings * rounding * extent);
}

/// Nearer than this, pairs of a bucket are of interest, to contacts or to the filter, for as long as neither cluster has gone far
/// (has_gone_far): to twice what its extent was when all was last looked at anew, wherever it is now.
inline float PairSystem::care_of(const Between& clusters) const {
  const float extent = max(extent_[clusters.first], extent_[clusters.second]);
  return max(cull_slack * material(clusters).thickness, 2 * max(least_of(clusters), least_roundings * rounding * extent));
}

}  // namespace pliant
