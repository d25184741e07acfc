// The cost of a chain of ball joints with a heavy end: solved directly, against sweeps over its joints (`pliant bench
// joints`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

struct ChainRow {
  int links = 0;
  std::string solver;  ///< "direct" or "sweeps"
  int substeps = 0;
  double ms_per_frame = 0;  ///< median processor time of a frame [ms]
  double drift = 0;         ///< the largest gap of a joint after any frame [m]
  double ratio = 0;         ///< the time over that of the sweeps
};

struct ChainOptions {
  std::vector<int> sizes{100};  ///< numbers of links
  int frames = 600;
  std::function<void(const ChainRow&)> on_row;
};

/// Links of 0.5 m and 1 kg, the last one 100 kg, are let go from horizontal: solved directly with 8, 4 and 2 substeps,
/// and by 40 substeps of sweeps over the joints. All take turns frame by frame, on one thread. Throws an Error if a
/// size is below 2.
std::vector<ChainRow> measure_chains(const ChainOptions& options);

std::string to_json(const std::vector<ChainRow>& rows);

}  // namespace pliant::bench
