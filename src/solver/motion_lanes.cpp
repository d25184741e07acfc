// Motion of frames and bodies in sixteen SIMD lanes, compiled per instruction set level under the rules of
// solver/lanes.cpp.
#include "solver/motion_loops.h"
#include "solver/motion_wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

namespace {
struct ThisUnit {};
}  // namespace

}  // namespace PLIANT_ISA

const MotionKernels& PLIANT_OF_LEVEL(motion_kernels)() { return motion_formulas::Loops<Wide, 16, ThisUnit>::table; }

}  // namespace pliant
