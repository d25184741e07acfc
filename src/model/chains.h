// Compiles distance constraints to paths, and tethers to pins: the data of the chain sweep.
#pragma once

#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

/// Marks the distance constraints that chains solve: compliant and rigid ones with a positive rest length. Attachments
/// have rest length zero, so no direction to solve along; damped and PBD distances do not fit a linear system. Both go
/// to separate lists, which are swept as usual. Chains end at the targets of `held` instead of at the particles:
/// attachments are projected before the chains, which would pull held particles away again.
void split_off_chains(std::vector<ConstraintList>& lists, const std::vector<int>& held);

/// Decomposes the marked lists into paths and appends these. The object must have its storage order and its pools.
void append_chains(const std::vector<ConstraintList>& lists, float softness, CompiledObject& out);

/// For each dynamic particle, the geodesic distances along constraints and triangles to the four nearest groups of
/// anchors (in each to the nearest one), times 1 + slack. The object must have its surface. `anchors` are ascending
/// storage indices of fixed particles.
Tethers find_tethers(const std::vector<ConstraintList>& lists, float slack, const std::vector<int>& anchors,
                     const CompiledObject& object);

}  // namespace pliant
