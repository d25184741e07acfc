// The filter that prevents crossing: two primitives that are apart at the substep's start stay on either side of a
// separating plane. It truncates the steps of vertices that would enter the separating margin.
//
// A linear path with both ends in a half-space stays in it, so nothing crosses on the way, and no root is computed.
// Truncating a step towards its start violates no other pair's plane. So each vertex takes the smallest step that any pair
// permits, in any order. ../../docs/guide/contact.md has the whole argument.
#pragma once

#include "collision/proxies/pair_stencil.h"

namespace pliant {

/// The separating margin of a pair: the first side stays at normal . (x - origin) >= above, the other <= below.
struct SeparatingSlab {
  PairStencil pair;
  Vec3d normal{};
  double above = 0, below = 0;  ///< relative to the pair's first particle at the start [m]
};

/// The outcome for a pair.
enum class Separation {
  free,         ///< no step enters the margin
  planned,      ///< `slab` is valid, `shares` are the permitted shares of the steps
  unresolvable  ///< no plane: they touch at the start, or a kinematic vertex moves too far
};

/// Computes the margin of a pair at distance `at`, of thickness min(least, 0.98 gap), and the share of each particle's step
/// that keeps it on its side. Steps are those of the rounded positions; particles of zero inverse mass keep theirs.
Separation plan_separation(const PairStencil& pair, const PairDistance& at, const Record* positions,
                           const Record* displacements, double least, SeparatingSlab& slab, std::array<float, 4>& shares);

/// True if particle `which` of the pair ends on the wrong
/// side, rounded, when its displacement is scaled by `share`.
bool ends_beyond(const SeparatingSlab& slab, int which, const Record* positions, const Record* displacements, float share);

}  // namespace pliant
