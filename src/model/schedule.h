// The schedule of an object's constraints: segments of batches, tile by tile and colour by colour, and the phases that
// visit them.
#pragma once

#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

/// Schedules one list after another, and frees each that no later step of compile() reads, to limit the peak of memory.
/// `tile` is that of each particle, by the user's index. With `in_given_order`, each constraint has a colour of its
/// own; with `keeps_lengths`, lists of distance constraints stay. Constraints that have a place in `kept` (null: there
/// is none) stay there, others get new colours.
void schedule(std::vector<ConstraintList>& lists, const std::vector<int>& tile, bool in_given_order, bool keeps_lengths,
              const KeptSchedule* kept, CompiledObject& out);

/// Schedules the constraints that are projected one at a time, list by list, in colours over the whole object. Frames
/// have indices after all particles.
void schedule_stencils(std::vector<ConstraintList>& lists, bool in_given_order, CompiledObject& out);

}  // namespace pliant
