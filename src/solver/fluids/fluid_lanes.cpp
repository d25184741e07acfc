// The passes of a liquid in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "math/lane_bits.h"
#include "solver/fluids/wide_inverse_root.h"
#include "solver/fluids/wide_slots.h"

#include "solver/fluids/fluid_loops.h"  // after what it uses for lanes

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

struct ThisUnit {};

struct WideLanes : WideSlots {
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
