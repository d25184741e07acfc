// All constraints at once from the same positions.
//
// A particle with n constraints can't take all n corrections whole: they would overshoot. Split: each constraint sees an
// n-th of the particle's mass, n times its w, and the particle follows the mean of its parts: every pair of forces stays a
// pair, so momentum is kept (Tonge et al. 2012). Average: each sees the whole mass and the corrections are averaged, which
// breaks the pairs wherever neighbours have different n (Macklin et al. 2014, section 4.2).
#pragma once

#include "model/model.h"
#include "pliant/scene.h"
#include "solver/sweeps/scratch.h"

namespace pliant {

/// Makes the lists and buffers of an object.
void prepare_jacobi(const Model& model, int object, const SweepOptions& options, std::vector<JacobiObject>& objects);

}  // namespace pliant
