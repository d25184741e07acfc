// Records of sixteen indices, as the formulas of frames and bodies load and store them.
#pragma once

#include "math/lane_bits.h"
#include "math/wide.h"
#include "solver/frame_formulas.h"

namespace pliant {
inline namespace PLIANT_ISA {

PLIANT_HD motion_formulas::RecordOf<Wide> load_records(const Record* base, const std::int32_t* index, const Wide&) {
  const WideRecords r = from_registers(load_indexed(base, index));
  return {r.position, r.w};
}
PLIANT_HD void store_records(Record* base, const std::int32_t* index, const motion_formulas::RecordOf<Wide>& r) {
  store_indexed(base, index, to_registers({r.xyz, r.w}));
}

}  // namespace PLIANT_ISA
}  // namespace pliant
