// Who made the first value that is not finite.
#pragma once

#include "parallel/executor.h"
#include "pliant/world.h"
#include "solver/step.h"

namespace pliant {

/// After a tile was found with a position that is not finite: replays the substep's sweep over all such tiles of the object from
/// their prediction, one segment at a time, and names the first constraint whose particles are not finite after it. Since a sweep
/// gives the same bits each time, the replay meets what the run met. Then puts the tiles back to where the substep began, so that
/// the state is finite again.
NonFinite diagnose(const StepContext& context, FunctionRef<SweepArguments(int)> arguments);

}  // namespace pliant
