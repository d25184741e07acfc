// The passes of viscosity in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {
/// inverse_root of math/inverse_root.h in each lane.
PLIANT_HD Wide inverse_root(const Wide& x) {
  Wide y;
  PLIANT_EACH_PART(y.part[i] = (Part)(0x5f375a86 - ((PartMask)x.part[i] >> 1)))
  const Wide half = Wide(0.5f) * x, three_halves(1.5f);
  y = y * (three_halves - half * y * y);
  return y * (three_halves - half * y * y);
}
}  // namespace PLIANT_ISA
}  // namespace pliant

#include "solver/fluids/viscosity_loops.h"  // after what it uses for lanes

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

constexpr std::int32_t own_lanes[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

struct WideLanes {
  using Value = Wide;
  static constexpr int count = wide_width;

  PLIANT_HD static WideRecords load(const Record* base, const std::int32_t* slots) {
    return from_registers(pliant::load_indexed(base, slots));
  }
  PLIANT_HD static WideRecords load_own(const Record* from) { return load(from, own_lanes); }
  PLIANT_HD static Wide load(const float* from) { return load_wide(from); }
  PLIANT_HD static Wide load_indexed(const float* base, const std::int32_t* slots) {
    float values[wide_width];
    for (int lane = 0; lane < wide_width; ++lane) values[lane] = base[slots[lane]];
    return load_wide(values);
  }
  PLIANT_HD static void store(float* to, const Wide& a) { store_wide(to, a); }
  PLIANT_HD static void store_own(Record* to, const Vec3<Wide>& position, const Wide& w) {
    store_indexed(to, own_lanes, to_registers({position, w}));
  }
};

}  // namespace
}  // namespace PLIANT_ISA

const ViscosityKernels& PLIANT_OF_LEVEL(viscosity_kernels)() {
  return viscosity_formulas::Loops<WideLanes, ThisUnit>::table;
}

}  // namespace pliant
