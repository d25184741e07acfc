// The triangles of marching cubes (Lorensen and Cline 1987) for each of the 256 cases of a cell.
//
// The table is computed. On each face of the cell, segments cut off each run of inside corners, so two inside corners
// across a diagonal are separated. The rule depends on the face alone, so the cells on both sides agree, and the mesh
// is closed. Segments form loops, one through each edge that the surface crosses. Loops are triangulated without
// diagonals that lie in a face of the cell, because the next cell could have the same diagonal, and an edge would get
// four triangles.
#pragma once

#include <array>
#include <cstdint>

namespace pliant::surface {

inline constexpr int most_triangles = 5;  ///< of one case

/// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge 4 a + n is along axis a, from corner
/// edge_start(edge).
struct CubeCase {
  std::uint8_t count = 0;  ///< of triangles
  std::uint8_t crossed_count = 0;
  std::array<std::array<std::uint8_t, 3>, most_triangles> triangles{};  ///< edges, counter-clockwise from outside
  std::array<std::uint8_t, 12> crossed{};                               ///< the edges that the surface crosses
  /// By edge: the one that follows it, where the surface leaves the cell through a face.
  std::array<std::uint8_t, 12> next{};
};

/// The corner at which an edge starts; it ends at the corner with the bit of its axis set.
constexpr int edge_start(int edge) {
  const int n = edge & 3;
  switch (edge >> 2) {
    case 0:
      return (n & 1) << 1 | (n & 2) << 1;
    case 1:
      return (n & 1) | (n & 2) << 1;
    default:
      return n;
  }
}

/// By the corners that are inside, bit c for corner c.
const std::array<CubeCase, 256>& cube_cases();

}  // namespace pliant::surface
