#include "solver/motion_kernels.h"

#include "math/scalar.h"

namespace pliant::motion_formulas {
PLIANT_HD bool all_zero(float sum) { return sum == 0; }
}  // namespace pliant::motion_formulas

#include "solver/motion_loops.h"  // after what it uses for floats

namespace pliant {

namespace {
struct ThisUnit {};
}  // namespace

const MotionKernels& motion_kernels_sequential() { return motion_formulas::Loops<float, 1, ThisUnit>::table; }

}  // namespace pliant
