// Smoothing of a closed mesh that keeps its volume.
#pragma once

#include "pliant/mesh.h"

namespace pliant::surface {

/// Smooths by Taubin's filter (1995): each pass moves vertices towards the mean of their neighbours, then away from it by slightly more,
/// which removes bumps of a few edges and leaves longer ones.
void smooth(TriangleMesh& mesh, int passes);

}  // namespace pliant::surface
