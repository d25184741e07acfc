// All constraint types of the library with a fixed stencil. To add one: write its header, include it here and add it to the
// list. Pools, sweeps, files, tests and docs follow from the list (docs/internals/architecture.md, "Adding a constraint").
#pragma once

#include "constraints/dihedral_bending.h"
#include "constraints/distance.h"
#include "constraints/isometric_bending.h"
#include "constraints/traits.h"
#include "constraints/type_list.h"

namespace pliant {

/// The order of the list is the order of visits in a sweep.
using AllConstraints = TypeList<Distance, DihedralBending, IsometricBending>;

}  // namespace pliant
