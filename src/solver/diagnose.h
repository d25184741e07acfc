// Finds which constraint made the first non-finite value.
#pragma once

#include "pliant/report.h"
#include "solver/substep.h"

namespace pliant {

/// Call it after a tile has a non-finite displacement. It predicts the object's substep again, replays the sweep
/// segment by segment, and names the first constraint that makes a particle non-finite. Then it resets the
/// displacements of such tiles, so that the State is finite and that of the substep's start.
NonFinite diagnose(const Substep& s);

}  // namespace pliant
