// Geodesic distances from a mesh's vertices to source vertices, along its edges and across its triangles.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// A source vertex that is near, and its distance.
struct NearSource {
  int source = 0;  ///< index of the source vertex
  double distance = 0;
};

/// A mesh for the computation of geodesic distances: edges with lengths, and triangles.
struct Distances {
  int vertices = 0;
  std::vector<std::array<int, 2>> edges;
  std::vector<float> lengths;  ///< length of each edge, >= 0 [m]
  /// Triangles that paths may cross. A triangle is ignored unless all three of its edges are present.
  std::vector<std::array<int, 3>> triangles;
};

/// For each vertex, the nearest source of each of the `most` nearest groups that it can reach, nearest first. Sources
/// joined by an edge form one group, so that a pinned hem counts once. A source is at distance 0 from itself.
///
/// Dijkstra (1959) along edges, plus unfolding of triangles into the plane of the crossed
/// ones (Novotni and Klein 2002). Exact on developable surfaces without holes in the way,
/// such as cloth cut from a plane. Never below the straight line, except for rounding. Ties
/// go to the smaller number, so the result is the same on any machine. O(most E log E).
std::vector<std::vector<NearSource>> nearest_sources(const Distances& mesh, const std::vector<int>& sources, int most);

}  // namespace pliant
