// Queries of what a closed mesh encloses, for makers of particles and tetrahedra.
#pragma once

#include "collision/fields/mesh_query.h"
#include "pliant/mesh.h"

namespace pliant {

/// Throws an Error unless the vertices are finite, the triangles use vertices that exist, and each edge has two
/// triangles.
MeshQuery query_of_closed(const TriangleMesh& mesh);

}  // namespace pliant
