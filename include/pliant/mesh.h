// Triangle meshes as values, and their inspection.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// An indexed triangle mesh. Positions in metres; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<int, 3>> triangles;
};

/// A finding about a mesh or a scene. The engine rejects input with `grave` findings; others are warnings or notes.
struct Finding {
  bool grave = false;
  std::string message;  ///< the problem and its place: "3 sliver triangles, the first 17 (aspect 1:4000)"
  std::string advice;   ///< the remedy
};

/// A flat rectangle of `columns` x `rows` vertices, `width` x `depth` metres, in the xz-plane, centred at the origin,
/// facing +y. Vertex (row r, column c) has index r * columns + c; each cell's diagonal runs from (r, c) to (r + 1, c + 1).
/// Throws an Error unless columns, rows >= 2 and the sizes are positive and finite.
TriangleMesh grid_mesh(int columns, int rows, float width, float depth);

/// A closed unit sphere about the origin: an icosahedron whose faces are split into four `subdivisions` (0..7) times.
TriangleMesh sphere_mesh(int subdivisions);

/// All findings about a mesh without a scene: duplicates, degenerate and sliver triangles, non-manifold or inconsistently
/// wound edges, isolated vertices, non-finite or huge coordinates, open boundary loops, number of connected components.
std::vector<Finding> inspect(const TriangleMesh& mesh);

}  // namespace pliant
