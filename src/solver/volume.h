// The volume of a closed mesh as one constraint over all of its particles.
//
//   C = sum over triangles of (x1 x x2) . x3  -  pressure * 6 V0          Mueller et al. 2007, section 4.4.2
//
// The sum is six volumes. The gradient at a particle is the sum of x_j x x_k over the triangles (i, j, k) around it; on a
// closed mesh the ring closes and this equals the sum of (x_j - x_i) x (x_k - x_i), which does not lose digits far from the
// origin. C is homogeneous of degree three, so sum_i x_i . grad_i C is three times six volumes: one pass over the particles
// gives all sums. Each tile adds up its own particles in order and the tiles are added in order: the same bits on any
// number of threads.
#pragma once

#include "model/model.h"
#include "model/substep.h"
#include "parallel/executor.h"
#include "solver/workspace.h"

namespace pliant {

/// Projects the volume constraints once of those objects that take part. `arguments(object)` gives the particles of one.
void project_volumes(const Model& model, Workspace& workspace, Executor& executor,
                     FunctionRef<SweepArguments(int)> arguments, FunctionRef<bool(int)> takes_part);

/// The gradient of C at one particle [m^2].
Vec3f volume_gradient(const CompiledObject& object, const Record* positions, int particle);

/// C of one object now [m^3].
double volume_error(const CompiledObject& object, const Record* positions);

}  // namespace pliant
