// One number of a row in memory, as formulas load and store it whose scalar is a float or double; wide_rows.h has
// sixteen.
#pragma once

#include "pliant/formula.h"

namespace pliant {

PLIANT_HD void load_row(const float* from, float& to) { to = *from; }
PLIANT_HD void store_row(float* to, float from) { *to = from; }
PLIANT_HD void load_row(const float* from, double& to) { to = static_cast<double>(*from); }
PLIANT_HD void store_row(float* to, double from) { *to = static_cast<float>(from); }

}  // namespace pliant
