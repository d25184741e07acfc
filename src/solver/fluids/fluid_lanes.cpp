// The passes of a liquid in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "math/lane_bits.h"
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

#include "solver/fluids/fluid_loops.h"  // after what it uses for lanes

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

struct WideLanes {
  using Value = Wide;
  static constexpr int count = wide_width;

  PLIANT_HD static WideRecords load(const Record* base, const std::int32_t* slots) {
    return from_registers(load_indexed(base, slots));
  }
  PLIANT_HD static WideRecords load_own(const Record* from) {
    constexpr std::int32_t lanes[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return load(from, lanes);
  }
  PLIANT_HD static Wide load(const float* from) { return load_wide(from); }
  PLIANT_HD static void store(float* to, const Wide& a) { store_wide(to, a); }
  PLIANT_HD static void store_own(Record* to, const Vec3<Wide>& position, const Wide& w) {
    constexpr std::int32_t lanes[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    store_indexed(to, lanes, to_registers({position, w}));
  }
  PLIANT_HD static int number_of(const WideMask& mask) { return __builtin_popcount(lane_bits(mask)); }
  PLIANT_HD static void store_vectors(Vec3f* to, const Vec3<Wide>& a) {
    Record records[wide_width];
    store_own(records, a, Wide(0.f));
    for (int lane = 0; lane < wide_width; ++lane) to[lane] = {records[lane].x, records[lane].y, records[lane].z};
  }
  /// Moves the particles of sixteen slots.
  PLIANT_HD static void add(const FluidArrays& a, int slot, const Vec3<Wide>& way) {
    Record by[wide_width];
    store_own(by, way, Wide(0.f));
    const int last = a.slots - slot < wide_width ? a.slots - slot : wide_width;
    for (int lane = 0; lane < last; ++lane) {
      Record& d = a.displacements[a.points[slot + lane]];
      d = {d.x + by[lane].x, d.y + by[lane].y, d.z + by[lane].z, d.w};
    }
  }
};

}  // namespace
}  // namespace PLIANT_ISA

const FluidKernels& PLIANT_OF_LEVEL(fluid_kernels)() { return fluid_formulas::Loops<WideLanes, ThisUnit>::table; }

}  // namespace pliant
