// What joins the triangles of a surface: its edges and its hinges.
//
// Everything is found by sorting half-edges, never by hashing, so that the order of the result is a function of the
// triangles alone: constraints made from it come in the same order on every machine, and bits follow order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

/// Three vertices, as in TriangleMesh::triangles.
using Triangle = std::array<int, 3>;

/// An edge with the first two triangles that use it, in the triangles' order. Entries that do not exist are -1.
struct Edge {
  int a = 0, b = 0;        ///< its ends, a < b
  int triangle_count = 0;  ///< 1 at a border, 2 inside, more where the surface is not a manifold
  std::array<int, 2> triangles{-1, -1};
  std::array<int, 2> opposites{-1, -1};       ///< the corner of each of `triangles` that is not on the edge
  std::array<bool, 2> forward{false, false};  ///< whether each of `triangles` runs from a to b

  bool is_border() const { return triangle_count == 1; }
  bool is_inner() const { return triangle_count == 2; }
  /// Whether its two triangles are wound alike: neighbours run along their edge in opposite directions.
  bool is_wound_consistently() const { return triangle_count != 2 || forward[0] != forward[1]; }
};

/// Two triangles that share the edge v0-v1:
///
///          v2
///         /  \          v0 -> v1 runs forward in the triangle of v2. The four corners alone define the fold's sign;
///       v0 -> v1        the winding of the rest of the surface does not matter.
///         \  /
///          v3
struct Hinge {
  int v0 = 0, v1 = 0, v2 = 0, v3 = 0;
};

/// Throws Error naming the first triangle with a corner outside 0..vertex_count - 1.
void require_indices(const std::vector<Triangle>& triangles, int vertex_count);

/// Every edge once, in ascending order of (a, b). A "side" from a vertex to itself (a triangle that uses a vertex twice) is
/// no edge. O(n) for meshes as they come, O(n log n) at worst. Throws Error as require_indices does.
std::vector<Edge> find_edges(const std::vector<Triangle>& triangles, int vertex_count);

/// One hinge for each edge of exactly two triangles, in the edges' order.
std::vector<Hinge> find_hinges(const std::vector<Edge>& edges);

/// The hinge across an inner edge.
Hinge hinge_of(const Edge& edge);

}  // namespace pliant
