// The passes of a liquid for one slot at a time: the readable reference.
#include "solver/fluids/fluid_loops.h"
#include "solver/fluids/one_slot.h"

namespace pliant {

namespace {

struct OneDensitySlot : OneSlot {
  static int number_of(bool is_set) { return is_set ? 1 : 0; }
  static void store_vectors(Vec3f* to, const Vec3f& a) { *to = a; }
  static void add(const FluidArrays& a, int slot, const Vec3f& way) {
    if (slot >= a.slots) return;
    Record& d = a.displacements[a.points[slot]];
    d = {d.x + way.x, d.y + way.y, d.z + way.z, d.w};
  }
};

}  // namespace

const FluidKernels& fluid_kernels_sequential() { return fluid_formulas::Loops<OneDensitySlot, void>::table; }

}  // namespace pliant
