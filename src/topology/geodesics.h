// Geodesic distances from a mesh's vertices to source vertices, along its edges and across its triangles.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// A source near a vertex, and its distance.
struct NearSource {
  int source = 0;  ///< a vertex
  double distance = 0;
};

/// The connectivity and lengths of a mesh for geodesic distances.
struct Distances {
  int vertices = 0;
  std::vector<std::array<int, 2>> edges;
  std::vector<float> lengths;  ///< one per edge, >= 0
  /// Triangles that paths may cross. A triangle is ignored unless all three of its edges are present.
  std::vector<std::array<int, 3>> triangles;
};

/// For each vertex: the nearest source of each of the `most` nearest groups, nearest first; fewer if fewer are reachable.
/// Sources joined by an edge form one group, so that a pinned hem counts once. A source has distance 0 to itself.
///
/// Dijkstra (1959) along edges, plus unfolding of triangles into the plane of the crossed
/// ones (Novotni and Klein 2002). Exact on developable surfaces without holes in the way,
/// such as cloth cut from a plane. Never below the straight line, except for rounding. Ties
/// go to the smaller number, so the result is the same on any machine. O(most E log E).
std::vector<std::vector<NearSource>> nearest_sources(const Distances& mesh, const std::vector<int>& sources, int most);

}  // namespace pliant
