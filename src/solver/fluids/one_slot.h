// How the passes over one slot at a time load and store it: the readable reference.
#pragma once

#include <cstdint>

#include "pliant/state.h"

namespace pliant {

struct OneSlot {
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
};

}  // namespace pliant
