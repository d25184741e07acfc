// How far it is from a mesh's vertices to some of them, along its edges and across its triangles.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// A source near a vertex, and how far it is there.
struct NearSource {
  int source = 0;  ///< a vertex
  double distance = 0;
};

/// A mesh as far as distances within it go.
struct Distances {
  int vertices = 0;
  std::vector<std::array<int, 2>> edges;
  std::vector<float> lengths;  ///< one an edge, >= 0
  /// Triangles to cross; those that have not all three edges are not crossed.
  std::vector<std::array<int, 3>> triangles;
};

/// For every vertex the nearest source of each of the `most` nearest groups of sources, nearest first; fewer where fewer can be
/// reached. Sources joined by an edge are of one group, so that a pinned hem counts once. A source has itself at distance 0.
///
/// Dijkstra (1959) along the edges; and from two vertices of a triangle to its third as if the triangle and all that the line
/// crossed lay flat, with the source where the two distances put it (Novotni and Klein 2002). Exact on what can be laid flat
/// and has no hole in the way, such as cloth cut from a plane; never below the straight line by more than rounding. Ties go to
/// the smaller number: the same on any machine. O(most E log E).
std::vector<std::vector<NearSource>> nearest_sources(const Distances& mesh, const std::vector<int>& sources, int most);

}  // namespace pliant
