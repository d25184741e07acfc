// The passes of surface tension for one slot at a time: the readable reference.
#include "solver/fluids/one_slot.h"
#include "solver/fluids/tension_loops.h"

namespace pliant {

const TensionKernels& tension_kernels_sequential() { return tension_formulas::Loops<OneSlot, void>::table; }

}  // namespace pliant
