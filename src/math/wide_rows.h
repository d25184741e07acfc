// Rows of sixteen floats in memory, as formulas load and store them whose scalar is Wide; rows.h has those of one
// number.
#pragma once

#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {

// Part by part: g++ copies a whole Wide in pieces of 16 bytes, and loads of 32 bytes wait for such stores.
PLIANT_HD void load_row(const float* from, Wide& to) {
  PLIANT_EACH_PART(std::memcpy(&to.part[i], from + part_width * i, sizeof(Part)));
}
PLIANT_HD void store_row(float* to, const Wide& from) {
  PLIANT_EACH_PART(std::memcpy(to + part_width * i, &from.part[i], sizeof(Part)));
}

}  // namespace PLIANT_ISA
}  // namespace pliant
