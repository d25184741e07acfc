#include "solver/motion_kernels.h"

#include "solver/motion_loops.h"

namespace pliant {

const MotionKernels& motion_kernels_sequential() { return motion_formulas::Loops<float, 1, void>::table; }

}  // namespace pliant
