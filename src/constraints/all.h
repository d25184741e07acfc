// All constraint types of the library with a fixed stencil. To add one, write its header, include it here and add it to
// the list: pools, sweeps, files, tests and docs follow (docs/internals/architecture.md, "Adding a constraint").
#pragma once

#include "constraints/dihedral_bending.h"
#include "constraints/distance.h"
#include "constraints/isometric_bending.h"
#include "constraints/traits.h"
#include "constraints/type_list.h"

namespace pliant {

/// The types in the order in which a sweep visits them.
using AllConstraints = TypeList<Distance, DihedralBending, IsometricBending>;

}  // namespace pliant
