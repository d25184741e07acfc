// The surface of a field as a mesh, by marching cubes.
#pragma once

#include "surface/field.h"
#include "surface/linked_mesh.h"

namespace pliant::surface {

/// The triangles that separate the nodes above surface_level from the others.
LinkedMesh marching_cubes(const Field& field, Executor& executor);

}  // namespace pliant::surface
