#include "solver/bodies/rod_kernels.h"

#include "solver/bodies/rod_loops.h"

namespace pliant {

const RodKernels& rod_kernels_sequential() { return rod_formulas::Loops<float, double, 1, 1, void>::table; }

}  // namespace pliant
