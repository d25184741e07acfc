// The innermost loops of chains and tethers, one table for each instruction set as in solver/kernels.h; all give the same
// bits.
#pragma once

#include "math/levels.h"
#include "model/compiled_object.h"
#include "model/substep.h"

namespace pliant {

/// Floats of scratch that a link of sixteen chains takes.
inline constexpr int chain_scratch_floats = 160;

struct ChainKernels {
  /// Solves sixteen paths exactly. `links` are the segments of a ChainBatch, `softness` its sixteen; `multipliers` is its
  /// pool's array or null; `scratch` has room for steps x chain_scratch_floats and starts at a cache line.
  void (*solve_chain)(const Pool& pool, const Segment* links, int steps, const float* softness, float* multipliers,
                      const SweepArguments& arguments, float* scratch);

  /// Puts particles [first, last) of an object back to within their tethers; `first` is a multiple of 16, and so is `last`
  /// or it is the object's end. `anchors` holds position and displacement of each anchor, one after the other.
  void (*hold_tethers)(const Tethers& tethers, const Record* anchors, int first, int last, const SweepArguments& arguments);
};

PLIANT_DECLARE_LEVELS(ChainKernels, chain_kernels)
const ChainKernels& chain_kernels_sequential();

}  // namespace pliant
