// How the passes over sixteen slots load and store them, compiled per instruction set level under the rules of
// solver/lanes.cpp.
#pragma once

#include <cstdint>

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

struct WideSlots {
  using Value = Wide;
  static constexpr int count = wide_width;
  static constexpr std::int32_t own[wide_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

  PLIANT_HD static WideRecords load(const Record* base, const std::int32_t* slots) {
    return from_registers(load_indexed(base, slots));
  }
  PLIANT_HD static WideRecords load_own(const Record* from) { return load(from, own); }
  PLIANT_HD static Wide load(const float* from) { return load_wide(from); }
  PLIANT_HD static void store(float* to, const Wide& a) { store_wide(to, a); }
  PLIANT_HD static void store_own(Record* to, const Vec3<Wide>& position, const Wide& w) {
    store_indexed(to, own, to_registers({position, w}));
  }
};

}  // namespace PLIANT_ISA
}  // namespace pliant
