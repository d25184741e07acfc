// The passes of viscosity for one slot at a time: the readable reference.
#include "solver/fluids/one_slot.h"
#include "solver/fluids/viscosity_loops.h"

namespace pliant {

namespace {

struct OneViscositySlot : OneSlot {
  static float load_indexed(const float* base, const std::int32_t* slot) { return base[*slot]; }
};

}  // namespace

const ViscosityKernels& viscosity_kernels_sequential() {
  return viscosity_formulas::Loops<OneViscositySlot, void>::table;
}

}  // namespace pliant
