// The filter that makes crossing impossible: two primitives that are apart at the substep's start are kept on either side of a
// plane between them, by shortening the moves of vertices that would enter the slab about it.
//
// Straight paths that begin and end in a half-space stay there, so nothing crosses on the way either, and no root is
// looked for. Shortening a move towards its start breaks no other pair's plane: what a vertex may do is the least of what
// its pairs allow, in whatever order they are asked. ../../docs/guide/contact.md has the whole argument.
#pragma once

#include "collision/proxies/pair_stencil.h"

namespace pliant {

/// A slab between the sides of a pair: the first stays at normal . (x - origin) >= above, the other <= below.
struct SeparatingSlab {
  PairStencil pair;
  Vec3d normal{};
  double above = 0, below = 0;  ///< relative to the pair's first particle at the start [m]
};

/// What is made of a pair.
enum class Separation {
  free,         ///< no move enters the slab
  planned,      ///< `slab` holds, `shares` say how much of each move may be made
  unresolvable  ///< no plane: they touch at the start, or a vertex that the filter cannot limit moves too far
};

/// The slab for a pair at distance `at`, thick min(least, 0.98 gap), and the share of each particle's move that keeps it on its
/// side. Moves are those of the rounded positions; particles of zero inverse mass keep theirs.
Separation plan_separation(const PairStencil& pair, const PairDistance& at, const Record* positions,
                           const Record* displacements, double least, SeparatingSlab& slab, std::array<float, 4>& shares);

/// Whether particle number `which` of the slab's pair ends on the wrong side once its displacement is scaled by `share`, as
/// rounded.
bool ends_beyond(const SeparatingSlab& slab, int which, const Record* positions, const Record* displacements, float share);

}  // namespace pliant
