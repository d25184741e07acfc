// The passes of viscosity for one slot at a time: the readable reference.
#include "solver/fluids/viscosity_loops.h"

namespace pliant {

namespace {

struct ThisUnit {};

struct OneLane {
  using Value = float;
  static constexpr int count = 1;
  struct Loaded {
    Vec3f position;
  };

  static Loaded load_own(const Record* from) { return {{from->x, from->y, from->z}}; }
  static Loaded load(const Record* base, const std::int32_t* slot) { return load_own(base + *slot); }
  static float load(const float* from) { return *from; }
  static float load_indexed(const float* base, const std::int32_t* slot) { return base[*slot]; }
  static void store(float* to, float a) { *to = a; }
  static void store_own(Record* to, const Vec3f& position, float w) { *to = {position.x, position.y, position.z, w}; }
};

}  // namespace

const ViscosityKernels& viscosity_kernels_sequential() { return viscosity_formulas::Loops<OneLane, ThisUnit>::table; }

}  // namespace pliant
