// Where a surface passes through itself: edges that pierce triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/vec3.h"
#include "topology/edges.h"

namespace pliant {

struct SelfIntersections {
  bool complete = false;   ///< false where the search was given up because it would have taken too long
  std::size_t count = 0;   ///< edge-triangle pairs that share no vertex and properly cross
  int edge[2] = {-1, -1};  ///< the first pair's edge
  int triangle = -1;       ///< and triangle
};

/// Counts the pairs in which an edge crosses a triangle's inside with its own inside. Touching, lying in one plane and what
/// cannot be told from it in double precision do not count. Gives up after `most_pairs` comparisons of boxes (a second's
/// worth). `edges` as find_edges gives them; all positions finite.
SelfIntersections find_self_intersections(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles,
                                          const std::vector<Edge>& edges, std::uint64_t most_pairs = 300'000'000);

}  // namespace pliant
