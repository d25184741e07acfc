// The passes of surface tension in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "solver/fluids/tension_loops.h"

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

constexpr std::int32_t own_lanes[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

struct WideLanes {
  using Value = Wide;
  static constexpr int count = wide_width;

  PLIANT_HD static WideRecords load(const Record* base, const std::int32_t* slots) {
    return from_registers(load_indexed(base, slots));
  }
  PLIANT_HD static WideRecords load_own(const Record* from) { return load(from, own_lanes); }
  PLIANT_HD static Wide load(const float* from) { return load_wide(from); }
  PLIANT_HD static void store_own(Record* to, const Vec3<Wide>& position, const Wide& w) {
    store_indexed(to, own_lanes, to_registers({position, w}));
  }
};

}  // namespace
}  // namespace PLIANT_ISA

const TensionKernels& PLIANT_OF_LEVEL(tension_kernels)() { return tension_formulas::Loops<WideLanes, ThisUnit>::table; }

}  // namespace pliant
