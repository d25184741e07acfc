// The distance of two convex solids, or the depth of their overlap, by supports alone.
//
// Apart: the algorithm of Gilbert, Johnson and Keerthi 1988 on the cores. Overlapping cores: the polytope that grows
// towards the nearest face of their difference (van den Bergen 2001). In double precision; no function of libm but
// sqrt.
#pragma once

#include "geometry/convex_shape.h"

namespace pliant {

/// The nearest places of two solids.
struct ConvexDistance {
  double separation = 0;  ///< distance of the surfaces; negative: how far they must be moved apart [m]
  Vec3d normal{};         ///< unit vector from a to b, along which that is
  Vec3d on_a{}, on_b{};   ///< places on the surfaces [m]; on_b - on_a is separation x normal
};

/// Both in the frame of a, where b has a pose. Of cores that touch in one point the normal is one that separates them
/// there. Solids that are found to be farther apart than `reach` [m] have a separation between that and their own, and
/// no places.
ConvexDistance convex_distance(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b,
                               double reach = 1e300);

}  // namespace pliant
