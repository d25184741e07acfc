// What a surface is as a whole: closed or open, a manifold or not, of how many pieces, wound which way.
#pragma once

#include <vector>

#include "topology/edges.h"

namespace pliant {

/// Whether every edge joins exactly two triangles, and there is one at all.
bool is_closed(const std::vector<Edge>& edges);

/// Whether no edge has more than two triangles.
bool is_edge_manifold(const std::vector<Edge>& edges);

/// Whether neighbouring triangles are wound alike everywhere.
bool is_wound_consistently(const std::vector<Edge>& edges);

/// The border as closed chains of vertices without repetition, in the order of their smallest first edge; two loops that
/// touch in a vertex are told apart. Where edges of three or more triangles end a border, the chain that is left over is
/// open.
std::vector<std::vector<int>> boundary_loops(const std::vector<Edge>& edges, int vertex_count);

/// Pieces of a surface, joined by edges of two triangles, and how to wind each of them alike.
struct Pieces {
  int count = 0;
  std::vector<int> of_triangle;      ///< the piece of each triangle, numbered in the order of first triangles
  std::vector<int> flipped;          ///< triangles to turn so that each piece is wound alike: the fewer of its two sides
  std::vector<int> one_sided_edges;  ///< one edge (index) for each piece that has but one side, like a Moebius band
};

/// Finds the pieces by flood fill over edges of exactly two triangles. Pieces with but one side have nothing in `flipped`.
Pieces find_pieces(const std::vector<Edge>& edges, int triangle_count);

/// Turns the triangles named: (a, b, c) becomes (a, c, b).
void flip(std::vector<Triangle>& triangles, const std::vector<int>& which);

}  // namespace pliant
