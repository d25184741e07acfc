// The passes of a liquid for one slot at a time: the readable reference.
#include "solver/fluids/fluid_loops.h"

namespace pliant {

namespace {

struct ThisUnit {};

struct OneLane {
  using Value = float;
  static constexpr int count = 1;
  struct Loaded {
    Vec3f position;
    float w;
  };

  static Loaded load_own(const Record* from) { return {{from->x, from->y, from->z}, from->w}; }
  static Loaded load(const Record* base, const std::int32_t* slot) { return load_own(base + *slot); }
  static float load(const float* from) { return *from; }
  static void store(float* to, float a) { *to = a; }
  static void store_own(Record* to, const Vec3f& position, float w) { *to = {position.x, position.y, position.z, w}; }
  static int number_of(bool is_set) { return is_set ? 1 : 0; }
  static void store_vectors(Vec3f* to, const Vec3f& a) { *to = a; }
  static void add(const FluidArrays& a, int slot, const Vec3f& way) {
    if (slot >= a.slots) return;
    Record& d = a.displacements[a.points[slot]];
    d = {d.x + way.x, d.y + way.y, d.z + way.z, d.w};
  }
};

}  // namespace

const FluidKernels& fluid_kernels_sequential() { return fluid_formulas::Loops<OneLane, ThisUnit>::table; }

}  // namespace pliant
