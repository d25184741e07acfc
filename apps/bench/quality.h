// What a frame costs at equal quality: the substeps that a sweep needs until W1 hardly stretches, and their milliseconds.
#pragma once

#include <vector>

#include "apps/bench/bench.h"

namespace pliant::bench {

/// The bounds that W1 has to keep over all frames of a run.
inline constexpr double quality_p99 = 1.02, quality_largest = 1.10;

/// How a cloth of `size` x `size` with bending fares under the tiled sweep, and under chains with tethers: one row each, at the
/// fewest substeps of a geometric series that keep the bounds over `frames` frames. Where none up to the sweep's limit does,
/// the row is that of the limit, and `met` says no.
std::vector<Row> measure_quality(const std::string& workload, int size, int frames);

}  // namespace pliant::bench
