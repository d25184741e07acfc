// The sweep over a segment of one constraint type, as the units in lanes name it to each other.
#pragma once

#include "math/isa.h"
#include "model/pool.h"
#include "model/substep.h"

namespace pliant {
inline namespace PLIANT_LEVEL_ISA {

/// Defined for each type in a unit of its own (sweep_in_lanes.h).
template <class T>
struct SweepOf {
  static void sweep(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& arguments);
};

}  // namespace PLIANT_LEVEL_ISA
}  // namespace pliant
