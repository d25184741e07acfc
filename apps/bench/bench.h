// Benchmarks of whole frames, the engine and others in one run (`pliant bench`). Times of different runs or machines are
// not comparable; only ratios within a run are quoted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::bench {

/// The figures of one engine for one workload and size.
struct Row {
  std::string workload;  ///< a name from workloads()
  int size = 0;          ///< N of an N x N cloth
  std::string engine;    ///< "plain loop", "bullet" or "pliant"
  int threads = 1, substeps = 0, iterations = 0;
  double ms_per_frame = 0;       ///< median over the frames; the total time if a workload has no frames
  double ns_per_projection = 0;  ///< whole frame, including prediction and velocity update
  double stretch_mean = 0, stretch_p99 = 0, stretch_max = 0;  ///< length over rest length after the last frame
  double energy_lost = 0;                                     ///< energy lost by frame 40 [J]; W1-quality only
  bool met = true;                                            ///< W1-quality only: the bounds were met
  std::vector<PhaseTime>
      phases{};      ///< of "pliant": milliseconds per frame and phase, from a separate run that times phases
  double ratio = 0;  ///< speedup over the first row of the same workload and size
};

struct Options {
  std::string workload;  ///< name of the workload; empty: all
  std::vector<int> sizes{64, 128, 256, 512};
  int warm_up = 20, frames = 120;  ///< unmeasured and measured frames
  int threads = 0;                 ///< threads of the engine's second run; the first run has one; 0: all
  bool against_bullet = false;
  std::function<void(const Row&)> on_row;  ///< called as soon as a row is complete
};

struct Workload {
  std::string name, what;
};

/// All workloads.
const std::vector<Workload>& workloads();

/// True if this build includes Bullet.
bool has_bullet();

/// Throws an Error if the workload is unknown, a size is outside 2..4096, or Bullet is requested but not built in.
std::vector<Row> run(const Options& options);

/// The rows as a JSON list.
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::bench
