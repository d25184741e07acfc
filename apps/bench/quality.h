// What a frame costs at equal quality: the substeps that a sweep needs until a cloth hardly stretches, and their milliseconds.
#pragma once

#include <limits>
#include <vector>

#include "apps/bench/bench.h"

namespace pliant::bench {

/// A cloth of N x N with bending, and the bounds that it has to keep over all frames of a run.
struct QualityWorkload {
  enum class Kind { hung, irregular, draped } kind;
  Workload as;
  double p99, largest;
};

/// Hung by two corners; the same on an irregular mesh; and that draped over a ball, pinned nowhere, friction 0.3.
const std::vector<QualityWorkload>& quality_workloads();

/// How a cloth of `size` x `size` fares under the tiled sweep, under chains (with tethers where there are pins) and under
/// multigrid: one row each, at the fewest substeps of a geometric series that keep the bounds over `frames` frames. Where
/// none up to the sweep's limit does, the row is that of the limit, and `met` says no.
std::vector<Row> measure_quality(const QualityWorkload& workload, int size, int frames);

}  // namespace pliant::bench
