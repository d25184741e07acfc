// The connectivity of a surface: its edges and its hinges.
//
// Edges are found by sorting, never by hashing. So the order of edges and constraints depends on the triangles alone
// and is the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Three vertex indices, as in TriangleMesh::triangles.
using Triangle = std::array<int, 3>;

/// An edge with its first two triangles, ascending. Missing entries are -1.
struct Edge {
  int a = 0, b = 0;        ///< vertices of the edge, a < b
  int triangle_count = 0;  ///< number of triangles: 1 at a border, 2 inside, more at a non-manifold edge
  std::array<int, 2> triangles{-1, -1};
  std::array<int, 2> opposites{-1, -1};       ///< the corner opposite the edge in each of `triangles`
  std::array<bool, 2> forward{false, false};  ///< true if the triangle traverses the edge from a to b

  bool is_border() const { return triangle_count == 1; }
  bool is_inner() const { return triangle_count == 2; }
  /// True if the two triangles at the edge have the same winding: they then traverse the edge in opposite directions.
  bool is_wound_consistently() const { return triangle_count != 2 || forward[0] != forward[1]; }
};

/// Two triangles that share the edge v0-v1:
///
///          v2
///         /  \          The triangle of v2 traverses the edge from v0 to v1. The four corners alone define the
///       v0 -> v1        sign of the dihedral angle, independent of the winding elsewhere.
///         \  /
///          v3
struct Hinge {
  int v0 = 0, v1 = 0, v2 = 0, v3 = 0;
};

/// Throws an Error that names the first triangle with a corner outside 0..vertex_count - 1.
void require_indices(const std::vector<Triangle>& triangles, int vertex_count);

/// Returns each edge once, ascending by (a, b). A side from a vertex to itself (in a degenerate triangle) is no edge.
/// O(n) for usual meshes, O(n log n) at worst. Throws as require_indices does.
std::vector<Edge> find_edges(const std::vector<Triangle>& triangles, int vertex_count);

/// Returns one hinge for each edge of exactly two triangles, in the order of the edges.
std::vector<Hinge> find_hinges(const std::vector<Edge>& edges);

/// The hinge at an edge of exactly two triangles.
Hinge hinge_of(const Edge& edge);

}  // namespace pliant
