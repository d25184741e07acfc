// The passes of viscosity in sixteen SIMD lanes, compiled per instruction set level under the rules of
// solver/lanes.cpp.
#include "solver/fluids/wide_inverse_root.h"
#include "solver/fluids/wide_slots.h"

#include "solver/fluids/viscosity_loops.h"  // after what it uses for lanes

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

struct WideLanes : WideSlots {
  PLIANT_HD static Wide load_indexed(const float* base, const std::int32_t* slots) {
    float values[wide_width];
    for (int lane = 0; lane < wide_width; ++lane) values[lane] = base[slots[lane]];
    return load_wide(values);
  }
};

}  // namespace
}  // namespace PLIANT_ISA

const ViscosityKernels& PLIANT_OF_LEVEL(viscosity_kernels)() {
  return viscosity_formulas::Loops<WideLanes, ThisUnit>::table;
}

}  // namespace pliant
