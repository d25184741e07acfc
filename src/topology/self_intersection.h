// Finds self-intersections of a surface: edges that cross triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/vec3.h"
#include "topology/edges.h"

namespace pliant {

struct SelfIntersections {
  bool complete = false;   ///< false if the search was aborted because of its cost
  std::size_t count = 0;   ///< number of edges and triangles that cross and share no vertex
  int edge[2] = {-1, -1};  ///< vertices of the edge of the first pair
  int triangle = -1;       ///< index of the triangle of the first pair
};

/// Counts the pairs in which the interior of an edge crosses the interior of a triangle. Touching and coplanar pairs,
/// and those within double rounding of them, do not count. Aborts after `most_pairs` box tests (about a second).
/// `edges` must come from find_edges; all positions must be finite.
SelfIntersections find_self_intersections(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles,
                                          const std::vector<Edge>& edges, std::uint64_t most_pairs = 300'000'000);

}  // namespace pliant
