// The cost of a liquid that splashes, in lanes and as a plain loop (`pliant bench W5`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// One way to step a splash.
struct LiquidRow {
  int particles = 0;
  /// "plain loop", "pliant", "two threads", "stray" (one particle is 1 km away) or "1/60 s" (on two threads)
  std::string engine;
  std::string isa;  ///< the code path in use
  int substeps = 0;
  double median_ms = 0, largest_ms = 0;  ///< of a step: processor time; of two threads, time on the wall [ms]
  double ns_per_particle = 0;            ///< median time over particles and substeps [ns]
  double search = 0;                     ///< median share of the step that finds neighbours [-]
  double compression = 0;                ///< largest mean compression of a step [-]
  /// Median, over the steps, of the plain loop's time over that of this row; "two threads": one thread's over this.
  double ratio = 0;
  double bytes = 0;    ///< that World and Scene take, for each particle; 0: not measured
  double surface = 0;  ///< time to make the surface as a mesh, over that of a step; 0: not measured
};

struct LiquidOptions {
  std::vector<int> sizes{20000, 100000};  ///< numbers of particles, about
  int frames = 300;                       ///< steps
  std::function<void(const LiquidRow&)> on_row;
};

/// A block of liquid breaks in a tank of five times its length: particles 5 cm apart, steps of 5 ms, 5 substeps of one
/// iteration. The ways to step it take turns, step by step, on one thread except for "two threads" and "1/60 s". The
/// plain loop handles one particle after another, with the same neighbour lists, and gives the same bits, which is
/// checked; from 400 000 particles on it is left out. Throws an Error if a size is below 100 or above 10^7.
std::vector<LiquidRow> measure_liquids(const LiquidOptions& options);

std::string to_json(const std::vector<LiquidRow>& rows);

}  // namespace pliant::bench
