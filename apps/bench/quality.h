// The cost of a frame at equal quality: how many substeps a cloth needs so that it hardly stretches, and how long they
// take.
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

/// The workloads: cloth hung by two corners; the same on an irregular mesh; cloth without pins over a ball, friction
/// 0.3.
const std::vector<QualityWorkload>& quality_workloads();

/// Measures a cloth of `size` x `size` with the tiled sweep, with chains (and tethers if pinned) and with multigrid.
/// Each row has the fewest substeps of a geometric series that meet the bounds in all of `frames` frames. If no number
/// up to the sweep's limit does, the row is that of the limit, and `met` is false.
std::vector<Row> measure_quality(const QualityWorkload& workload, int size, int frames);

}  // namespace pliant::bench
