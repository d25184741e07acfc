// When tethers apply.
#pragma once

#include "model/compiled_object.h"

namespace pliant {

/// True if no two neighbouring anchors are farther from one another than at the start, by more than 1 %: otherwise no
/// place is within reach of both. Always true for tethers that the settings ask for. `positions` are the object's.
bool tethers_hold(const CompiledObject& object, const Record* positions);

}  // namespace pliant
