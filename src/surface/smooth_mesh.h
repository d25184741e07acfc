// Removes bumps shorter than a few edges from a mesh, and keeps its volume.
#pragma once

#include "surface/linked_mesh.h"

namespace pliant::surface {

/// Makes so many passes of Taubin's filter (1995).
void smooth(LinkedMesh& mesh, int passes, Executor& executor);

/// The mesh without links.
TriangleMesh unlinked(LinkedMesh mesh, Executor& executor);

}  // namespace pliant::surface
