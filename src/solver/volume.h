// The volume of a closed mesh as one constraint on all of its particles.
//
//   C = sum over triangles of (x1 x x2) . x3  -  pressure * 6 V0          Mueller et al. 2007, section 4.4.2
//
// The sum is six times the volume. The gradient at a particle is the sum of x_j x x_k over its triangles (i, j, k).
// On a closed mesh this equals the sum of (x_j - x_i) x (x_k - x_i), which stays precise far from the origin. C is
// homogeneous of degree three, so sum_i x_i . grad_i C is three times six volumes, and one pass gives all sums.
// Each tile sums its particles in order, and tiles are summed in order, so any number of threads gives the same
// bits.
#pragma once

#include <vector>

#include "model/model.h"
#include "model/substep.h"
#include "parallel/executor.h"
#include "solver/workspace.h"

namespace pliant {

/// Projects the volume constraints of some objects once. `tasks` are the indices in Model::tiles() of all tiles of
/// these objects, ascending. `arguments(object)` gives an object's particles.
void project_volumes(const Model& model, Workspace& workspace, Executor& executor,
                     FunctionRef<SweepArguments(int)> arguments, const std::vector<int>& tasks);

/// The gradient of C at one particle [m^2].
Vec3f volume_gradient(const CompiledObject& object, const Record* positions, int particle);

/// C of one object at given positions [m^3].
double volume_error(const CompiledObject& object, const Record* positions);

}  // namespace pliant
