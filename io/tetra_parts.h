// Parts of a tetrahedral mesh that touch without being connected.
#pragma once

#include <string>

#include "pliant/soft_body.h"

namespace pliant {

/// A note if nodes of several parts of the mesh, which share no node, have the same position; empty if there are none.
std::string note_of_touching_parts(const TetrahedralMesh& mesh);

}  // namespace pliant
