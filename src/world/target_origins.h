// Which targets of attachments go on when an object is edited.
#pragma once

#include <vector>

#include "model/compiled_object.h"

namespace pliant {

/// For each target of an attachment of `by`, the number of the target of `old` whose state it takes; -1: it is new.
/// Attachments are the same if they hold the same particle (after `from`, as Edit::from) to the same target with the
/// same stiffness; of several the first. Those that are left need the same particle and target; copies of a particle
/// share one. The rest needs the same target.
std::vector<int> target_origins(const CompiledObject& old, const CompiledObject& by, const std::vector<int>& from);

}  // namespace pliant
