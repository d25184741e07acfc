// The passes of surface tension for one slot at a time: the readable reference.
#include "solver/fluids/one_slot.h"
#include "solver/fluids/tension_loops.h"

namespace pliant {

namespace {

struct ThisUnit {};

}  // namespace

const TensionKernels& tension_kernels_sequential() { return tension_formulas::Loops<OneSlot, ThisUnit>::table; }

}  // namespace pliant
