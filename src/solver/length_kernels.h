// The search for distance constraints that are longer than their force explains: SIMD kernels for each instruction set,
// and a scalar twin with the same bits.
#pragma once

#include <cstdint>

#include "math/levels.h"
#include "model/pool.h"
#include "model/substep.h"

namespace pliant {

/// A constraint that a search found.
struct FoundLength {
  std::int32_t segment = 0, batch = 0, lane = 0;  ///< index in the object's segments, batch within it, and lane
  float value = 0;  ///< overstretch (C + explained) / rest length [-], or the substeps that it demands
};
/// Receives constraints that were found, some at a time.
using FoundLengthCallback = void (*)(void* context, const FoundLength* found, int count);

struct LengthQuery {
  const Record* positions = nullptr;      ///< of the object's first particle; w is the inverse mass
  const Record* displacements = nullptr;  ///< added to the positions; null: none
  float* const* multipliers = nullptr;    ///< one array per pool, or null if none are stored
  float inverse_h2 = 0;
  float above = 0;                     ///< constraints with a greater overstretch are reported [-]
  const Record* velocities = nullptr;  ///< of the object's first particle; null: damped constraints are left out
};

struct DemandQuery {
  const Record* positions = nullptr;  ///< of the object's first particle; w is the inverse mass
  const Record* velocities = nullptr;
  float by_stretch = 0,
        by_turn = 0;  ///< substeps per overstretch [-] and per speed across a constraint over its length [s]
  float above = 0;    ///< constraints that demand more substeps are reported
};

struct LengthKernels {
  /// Calls found(context, some, count) for the constraints of segments [first, last) with a positive rest length, a
  /// free particle and an overstretch above the query's, in order. The segments are of one pool of a length type
  /// (registry.h).
  void (*find_long)(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& query,
                    FoundLengthCallback found, void* context);

  /// The same for constraints that demand more substeps than the query's `above` (solver/substep_law.h).
  void (*find_demanding)(const Pool& pool, const Segment* segments, int first, int last, const DemandQuery& query,
                         FoundLengthCallback found, void* context);
};

PLIANT_DECLARE_LEVELS(LengthKernels, length_kernels)
const LengthKernels& length_kernels_sequential();

}  // namespace pliant
