// Searches among the distance constraints of an object. Constraints between two fixed particles are skipped: no solve
// changes them.
#pragma once

#include <array>
#include <vector>

#include "model/compiled_object.h"
#include "solver/length_kernels.h"

namespace pliant {

/// The two particles of a constraint that a search found, in storage order.
std::array<int, 2> ends_of(const CompiledObject& object, const FoundLength& found);

/// Appends the distance constraints of a range with an overstretch above the query's, in the order of the schedule.
/// Damped ones are left out unless the query has velocities, on which their damping force depends.
void find_long(const CompiledObject& object, const LengthRange& range, const LengthKernels& kernels,
               const LengthQuery& query, std::vector<FoundLength>& found);

/// Appends the distance constraints of a range that demand more substeps than the query's, in the order of the
/// schedule.
void find_demanding(const CompiledObject& object, const LengthRange& range, const LengthKernels& kernels,
                    const DemandQuery& query, std::vector<FoundLength>& found);

}  // namespace pliant
