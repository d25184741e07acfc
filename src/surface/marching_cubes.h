// The surface of a field as a mesh, by marching cubes.
#pragma once

#include "pliant/mesh.h"
#include "surface/field.h"

namespace pliant::surface {

/// The triangles that separate the nodes above surface_level from the others.
TriangleMesh marching_cubes(const Field& field, Executor& executor);

}  // namespace pliant::surface
