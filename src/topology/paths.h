// Paths laid along the edges of any mesh: what a solver that is exact along a line works on.
//
// The longer and straighter the paths, the farther one exact solve carries a pull. On a grid they are its rows, its columns
// and its diagonals, whole; on other meshes every edge goes on into the one that leaves its end most nearly straight ahead.
// Everything is decided by comparisons with total orders, so that the same mesh gives the same paths on any machine.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A line of edges that visits no vertex twice.
struct Path {
  std::vector<int> edges;     ///< in order, at least one
  std::vector<int> vertices;  ///< one more than edges; edge k joins vertices k and k + 1
};

/// Paths that share no vertex and may be solved together.
struct PathColour {
  std::vector<Path> paths;  ///< longest first
};

/// Lays paths so that every edge is in exactly one. `edges` hold two vertices each; edges from a vertex to itself must not
/// be among them, the same pair twice may. Colours come in the order in which they are to be visited, the one with the most
/// edges last: on a grid the diagonals, then rows and columns. Paths of one colour all run the same way as far as they can,
/// so that the solver's lanes pass through memory side by side.
std::vector<PathColour> lay_paths(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 2>>& edges);

}  // namespace pliant
