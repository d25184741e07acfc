// Finds the origin of the first non-finite value.
#pragma once

#include "pliant/report.h"
#include "solver/substep.h"

namespace pliant {

/// Call it after a tile has a non-finite displacement. Predicts the object's substep again, replays the sweep segment by
/// segment, and names the first constraint that makes a particle non-finite. Then resets the displacements of such tiles,
/// so that the State is finite and at the substep's start.
NonFinite diagnose(const Substep& s);

}  // namespace pliant
