// The passes over contacts of bodies for blocks of sixteen manifolds, one table for each instruction set level as in
// solver/kernels.h. All tables give the bits of the scalar functions (manifold_passes.h) called lane after lane.
#pragma once

#include "math/levels.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/bodies/manifold_rows.h"

namespace pliant {

/// Blocks [first, last) of one colour, and the motions of all bodies. Fixed bodies are read and never written.
struct BlockRange {
  ManifoldBlock* first;
  ManifoldBlock* last;
  BodyMotion* motions;
};

struct ManifoldKernels {
  void (*prepare)(const BlockRange& range);
  void (*warm_start)(const BlockRange& range);
  /// Returns true if any point bounced.
  bool (*bounce)(const BlockRange& range, float h, const Vec3f& fall);
  void (*position_pass)(const BlockRange& range, const PassNumbers& numbers);
  void (*velocity_pass)(const BlockRange& range, const PassNumbers& numbers);
};

PLIANT_DECLARE_LEVELS(ManifoldKernels, manifold_kernels)
const ManifoldKernels& manifold_kernels_sequential();

}  // namespace pliant
