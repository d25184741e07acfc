// The cost of a frame at equal quality: the substeps until a cloth hardly stretches, and their time.
#pragma once

#include <limits>
#include <vector>

#include "apps/bench/bench.h"

namespace pliant::bench {

/// An N x N cloth with bending, and the bounds that all frames of a run must meet.
struct QualityWorkload {
  enum class Kind { hung, irregular, draped } kind;
  Workload as;
  double p99, largest;
};

/// Cloth hung by two corners; the same on an irregular mesh; and cloth draped over a ball without pins, friction 0.3.
const std::vector<QualityWorkload>& quality_workloads();

/// Runs a cloth of `size` x `size` with the tiled sweep, with chains (and tethers if pinned) and with multigrid. Each row
/// has the fewest substeps of a geometric series that meet the bounds over `frames` frames. If none up to the sweep's limit
/// does, the row shows the limit, and `met` is false.
std::vector<Row> measure_quality(const QualityWorkload& workload, int size, int frames);

}  // namespace pliant::bench
