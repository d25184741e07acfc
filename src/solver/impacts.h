// The impacts on colliders that are about to happen, for the choice of substeps (substep_law.h).
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Predicts which particles of a group hit colliders within `seconds`. Returns the velocities of all particles of the
/// State if these stop at the colliders, or null if none hits one. Overwrites the displacements of the group.
const Record* velocities_after_impacts(Substep& s, double seconds);

}  // namespace pliant
