// Benchmarks of whole frames: this engine and others in one run (`pliant bench`). Only ratios within a run mean
// anything, because times of different runs or machines cannot be compared.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::bench {

/// The results of one engine for one workload and size.
struct Row {
  std::string workload;  ///< a name from workloads()
  int size = 0;          ///< N of an N x N cloth
  std::string engine;    ///< "plain loop", "bullet" or "pliant"
  int threads = 1, substeps = 0, iterations = 0;
  double ms_per_frame = 0;       ///< median time of a frame [ms]; total time for workloads without frames
  double ns_per_projection = 0;  ///< time of a whole frame, with prediction and velocity update, over its projections
  double stretch_mean = 0, stretch_p99 = 0, stretch_max = 0;  ///< length over rest length after the last frame
  double energy_lost = 0;                                     ///< energy lost by frame 40 [J]; W1-quality only
  bool met = true;  ///< true if the required quality was reached; W1-quality only
  /// For "pliant": time of each phase per frame [ms], from a separate run that times phases.
  std::vector<PhaseTime> phases{};
  double ratio = 0;  ///< time of the first row of the same workload and size over the time of this one
};

struct Options {
  std::string workload;  ///< name of the workload; empty: all
  std::vector<int> sizes{64, 128, 256, 512};
  int warm_up = 20, frames = 120;  ///< frames before the measurement, and frames measured
  int threads = 0;  ///< threads of the engine's second run; the first one uses one; 0: all hardware threads
  bool against_bullet = false;
  std::function<void(const Row&)> on_row;  ///< called for each row as soon as it is measured
};

struct Workload {
  std::string name, what;
};

/// All workloads.
const std::vector<Workload>& workloads();

/// True if this program was built with Bullet.
bool has_bullet();

/// Measures workloads. Throws an Error if a workload is unknown, a size is outside 2..4096, or Bullet is requested but
/// not built in.
std::vector<Row> run(const Options& options);

/// The rows as a JSON list.
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::bench
