// Who made the first value that is not finite.
#pragma once

#include "pliant/report.h"
#include "solver/substep.h"

namespace pliant {

/// After a tile was found with a displacement that is not finite: predicts its object's substep again and replays the
/// sweep, one segment at a time, and names the first constraint whose particles are not finite after it. Then takes the
/// displacements of such tiles back: their positions are those of the substep's start, so that the state is finite.
NonFinite diagnose(const Substep& s);

}  // namespace pliant
