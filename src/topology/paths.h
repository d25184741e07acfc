// Decomposition of a mesh's edges into paths, for solvers that are exact along a line.
//
// The longer and straighter a path, the farther one exact solve propagates a force. On a grid the paths are whole rows,
// columns and diagonals. On other meshes each edge continues into the straightest edge at its end. All choices are made
// in total orders, so the same mesh gives the same paths on any machine.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A path of edges that visits no vertex twice.
struct Path {
  std::vector<int> edges;     ///< indices of the path's edges, in order; at least one
  std::vector<int> vertices;  ///< one more than edges; edge k is between vertices k and k + 1
};

/// A set of paths that share no vertex, so that they can be solved at the same time.
struct PathColour {
  std::vector<Path> paths;  ///< paths of this colour, the longest first
};

/// Decomposes edges into paths; each edge is in exactly one path. `edges` has two different vertices for each edge;
/// duplicates are allowed. Colours are in the order of visits, the one with most edges last: on a grid diagonals,
/// then rows and columns. Paths of a colour are as parallel as possible, so that SIMD lanes read neighbouring
/// memory.
std::vector<PathColour> lay_paths(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 2>>& edges);

}  // namespace pliant
