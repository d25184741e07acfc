// Triangle meshes as values, and their inspection.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A triangle mesh with indices. Positions are in metres; triangles are counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<int, 3>> triangles;
};

/// What inspect() found in a mesh or scene. `grave` findings make the engine reject it; others are warnings or notes.
struct Finding {
  bool grave = false;
  std::string message;  ///< what is wrong and where: "3 sliver triangles, the first 17 (aspect 1:4000)"
  std::string advice;   ///< what to do about the problem
};

/// A flat rectangle of `columns` x `rows` vertices, `width` x `depth` metres, in the xz-plane, centred at the origin,
/// facing +y. Vertex (row r, column c) has index r * columns + c; each cell's diagonal runs from (r, c) to (r + 1, c +
/// 1). Throws an Error unless columns, rows >= 2 and the sizes are positive and finite.
TriangleMesh grid_mesh(int columns, int rows, float width, float depth);

/// A closed unit sphere about the origin: an icosahedron whose faces are split into four `subdivisions` (0..7) times.
TriangleMesh sphere_mesh(int subdivisions);

/// Inspects a mesh without a scene: duplicates, degenerate and sliver triangles, edges that are non-manifold or wound
/// inconsistently, isolated vertices, non-finite or huge coordinates, open boundaries, connected components.
std::vector<Finding> inspect(const TriangleMesh& mesh);

}  // namespace pliant
