// Decomposition of a mesh's edges into paths, for solvers that are exact along a line.
//
// Longer and straighter paths let one exact solve carry a force farther. On a grid the paths are whole rows, columns and
// diagonals. On other meshes each edge continues into the straightest edge at its end. All choices compare in total orders,
// so the same mesh gives the same paths on any machine.
#pragma once

#include <array>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A path of edges that visits no vertex twice.
struct Path {
  std::vector<int> edges;     ///< in order, at least one
  std::vector<int> vertices;  ///< one more than edges; edge k joins vertices k and k + 1
};

/// Paths that share no vertex and can be solved concurrently.
struct PathColour {
  std::vector<Path> paths;  ///< longest first
};

/// Decomposes the edges so that each is in exactly one path. `edges` hold two distinct
/// vertices each; duplicates are allowed. Colours come in visiting order, the one with
/// most edges last: on a grid the diagonals, then rows and columns. Paths of one
/// colour are as parallel as possible, so that SIMD lanes access neighbouring memory.
std::vector<PathColour> lay_paths(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 2>>& edges);

}  // namespace pliant
