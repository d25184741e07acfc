// Rods of equal shape in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "math/wide_double.h"
#include "math/wide_rows.h"
#include "solver/bodies/rod_loops.h"
#include "solver/motion_wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

namespace {
struct ThisUnit {};
}  // namespace

}  // namespace PLIANT_ISA

const RodKernels& PLIANT_OF_LEVEL(rod_kernels)() {
  return rod_formulas::Loops<Wide, WideDouble, wide_width, wide_double_width, ThisUnit>::table;
}

}  // namespace pliant
