// Benchmarks of whole frames, the engine beside others in one run: figures of different runs or machines are never
// compared, only their ratios within a run are quoted. `pliant bench` prints what this library measures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::bench {

/// One engine's figures for one workload at one size.
struct Row {
  std::string workload;  ///< a name from workloads()
  int size = 0;          ///< N of an N x N cloth
  std::string engine;    ///< "plain loop", "bullet" or "pliant"
  int threads = 1, substeps = 0, iterations = 0;
  double ms_per_frame = 0;       ///< median over the frames; the time itself where a workload has no frames
  double ns_per_projection = 0;  ///< of the whole frame, prediction and velocity update included
  double stretch_mean = 0, stretch_p99 = 0, stretch_max = 0;  ///< length over rest length after the last frame
  double energy_lost = 0;                                     ///< by frame 40 [J]; of W1-quality alone
  bool met = true;                                            ///< of W1-quality: whether the bounds were kept
  std::vector<PhaseTime>
      phases{};      ///< of "pliant": milliseconds a frame by phase, in a run of its own that times them apart
  double ratio = 0;  ///< how many times as fast as the first row of the same workload and size
};

struct Options {
  std::string workload;  ///< empty: all of them
  std::vector<int> sizes{64, 128, 256, 512};
  int warm_up = 20, frames = 120;  ///< frames before and during measurement
  int threads = 0;                 ///< of the engine's second run beside that with one thread; 0: all
  bool against_bullet = false;
  std::function<void(const Row&)> on_row;  ///< called as soon as a row is known
};

struct Workload {
  std::string name, what;
};

/// What there is to measure.
const std::vector<Workload>& workloads();

/// Whether Bullet was found when this was built.
bool has_bullet();

/// Throws Error where the workload is unknown, a size is out of 2..4096, or Bullet is asked for and was not built in.
std::vector<Row> run(const Options& options);

/// The rows as a JSON list.
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::bench
