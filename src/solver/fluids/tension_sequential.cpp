// The passes of surface tension for one slot at a time: the readable reference.
#include "solver/fluids/tension_loops.h"

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
  static void store_own(Record* to, const Vec3f& position, float w) { *to = {position.x, position.y, position.z, w}; }
};

}  // namespace

const TensionKernels& tension_kernels_sequential() { return tension_formulas::Loops<OneLane, ThisUnit>::table; }

}  // namespace pliant
