// Joins tetrahedra of solids that are nearly incompressible, so that those around an edge keep their volume together.
#pragma once

#include <vector>

#include "model/gather_constraints.h"
#include "pliant/kept_schedule.h"

namespace pliant {

/// Replaces TetrahedronVolume constraints by VolumeAroundEdge where the modulus of volume is at least four times that
/// of shear (a Poisson ratio of 0.4), which the TetrahedronShear or CorotationalStrain of the same corners tells. Each
/// tetrahedron is in one constraint; those that no others are left for keep their own. Lists whose rest data change
/// stay as they are. Returns the fans by number of their constraint. Those in `kept` (null: there is none) come first,
/// if their tetrahedra still are what is joined.
std::vector<KeptSchedule::Fan> join_volumes(std::vector<ConstraintList>& lists, const KeptSchedule* kept = nullptr);

}  // namespace pliant
