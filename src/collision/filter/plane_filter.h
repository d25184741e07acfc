// The filter of a single pair: two primitives that are apart at the substep's start stay on opposite sides of a
// separating plane. Steps of vertices that would enter the separating margin are truncated.
//
// A linear path with both ends in a half-space stays in it, so nothing crosses on the way, and no root is computed.
// Truncating a step towards its start violates no other pair's plane, if that stands still. So each vertex takes the
// smallest step that any pair permits, in any order. A pair that a moving plane keeps apart is free as well; it is
// tested again after each truncation. ../../docs/guide/contact.md has the whole argument.
#pragma once

#include "collision/proxies/pair_stencil.h"

namespace pliant {

/// The separating margin of a pair: normal . (x - origin) stays >= above for the first primitive, <= below for the
/// other.
struct SeparatingSlab {
  PairStencil pair;
  Vec3d normal{};
  Vec3f frame{};                   ///< displacement of the frame of reference in which the plane stands still [m]
  std::array<double, 4> weight{};  ///< of the closest points at the start, as in PairDistance
  double gap = 0;                  ///< along the normal at the start [m]
  double thickness = 0;            ///< the smallest gap that the filter permits [m]
  double above = 0, below = 0;     ///< heights along the normal above the pair's first particle at the start [m]
};

/// The result of planning a separating margin for a pair.
enum class Separation {
  free,         ///< no step enters the margin, or a plane that moves with the pair keeps it apart
  planned,      ///< `slab` is valid, `shares` are the permitted shares of the steps
  unresolvable  ///< no plane separates the pair: it touches at the start, or a kinematic vertex moves too far
};

/// The displacement of which only a share of its motion in a frame of reference is left.
inline Record truncated(const Record& d, const Vec3f& frame, float share) {
  if (share == 1) return d;
  return {frame.x + (d.x - frame.x) * share, frame.y + (d.y - frame.y) * share, frame.z + (d.z - frame.z) * share, 0};
}

/// Computes the separating margin of a pair at distance `at`, of thickness min(least, 0.98 gap), and for each particle
/// the share of its step in the frame that stays on its side (1 for zero inverse mass). Steps are those of rounded
/// positions.
Separation plan_separation(const PairStencil& pair, const PairDistance& at, const Record* positions,
                           const Record* displacements, const Vec3f& frame, double least, SeparatingSlab& slab,
                           std::array<float, 4>& shares);

/// True if particle `which` of the pair ends on the wrong side of its limit, after rounding, when its displacement is
/// scaled by `share`.
bool ends_beyond(const SeparatingSlab& slab, int which, const Record* positions, const Record* displacements,
                 float share);

}  // namespace pliant
