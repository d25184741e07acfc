// The passes of surface tension in sixteen SIMD lanes, compiled per instruction set level under the rules of
// solver/lanes.cpp.
#include "solver/fluids/tension_loops.h"
#include "solver/fluids/wide_slots.h"

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

}  // namespace
}  // namespace PLIANT_ISA

const TensionKernels& PLIANT_OF_LEVEL(tension_kernels)() { return tension_formulas::Loops<WideSlots, ThisUnit>::table; }

}  // namespace pliant
