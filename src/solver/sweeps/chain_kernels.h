// The inner loops of chains and tethers, one table of functions for each instruction set level as in solver/kernels.h.
// All levels give the same bits.
#pragma once

#include "math/levels.h"
#include "model/compiled_object.h"
#include "model/substep.h"

namespace pliant {

/// Number of scratch floats for one link of each of sixteen chains.
inline constexpr int chain_scratch_floats = 160;

struct ChainKernels {
  /// Solves sixteen chains exactly. `links`: the segments of a ChainBatch; `softness`: its sixteen values;
  /// `multipliers`: the pool's array or null; `scratch`: steps x chain_scratch_floats floats, aligned to a cache line.
  void (*solve_chain)(const Pool& pool, const Segment* links, int steps, const float* softness, float* multipliers,
                      const SweepArguments& arguments, float* scratch);

  /// Projects the particles [first, last) of an object onto their tethers. `first` and `last` are multiples of 16, or
  /// `last` is the object's end. `anchors` holds a position and a displacement for each anchor, in turn.
  void (*hold_tethers)(const Tethers& tethers, const Record* anchors, int first, int last,
                       const SweepArguments& arguments);
};

PLIANT_DECLARE_LEVELS(ChainKernels, chain_kernels)
const ChainKernels& chain_kernels_sequential();

}  // namespace pliant
