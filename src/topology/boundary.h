// Global properties of a surface: closed or open, manifold or not, connected components, winding.
#pragma once

#include <vector>

#include "topology/edges.h"

namespace pliant {

/// True if every edge has exactly two triangles. An empty mesh is not closed.
bool is_closed(const std::vector<Edge>& edges);

/// True if no edge has more than two triangles.
bool is_edge_manifold(const std::vector<Edge>& edges);

/// True if every two neighbouring triangles have the same winding.
bool is_wound_consistently(const std::vector<Edge>& edges);

/// The border as closed chains of vertices without repetition, ordered by their smallest first edge. Loops that
/// touch at a vertex are separate. At an edge of three or more triangles a border can end; its chain is then
/// open.
std::vector<std::vector<int>> boundary_loops(const std::vector<Edge>& edges, int vertex_count);

/// The connected components of a surface (across edges of two triangles), and which triangles to flip for equal
/// winding.
struct Pieces {
  int count = 0;
  std::vector<int> of_triangle;      ///< component of each triangle, numbered in the order of their first triangles
  std::vector<int> flipped;          ///< triangles to flip for consistent winding; in each component the fewer ones
  std::vector<int> one_sided_edges;  ///< an edge with conflicting windings for each non-orientable component
};

/// Finds the connected components by flood fill across edges of two triangles. Non-orientable ones have no `flipped`.
Pieces find_pieces(const std::vector<Edge>& edges, int triangle_count);

/// Reverses the winding of the given triangles: (a, b, c) becomes (a, c, b).
void flip(std::vector<Triangle>& triangles, const std::vector<int>& which);

}  // namespace pliant
