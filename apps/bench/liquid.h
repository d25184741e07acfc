// The cost of a liquid that splashes, in lanes and as a plain loop (`pliant bench W5`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

struct LiquidRow {
  int particles = 0;
  std::string engine;  ///< "plain loop" or "pliant"
  std::string isa;     ///< the code path in use
  int substeps = 0;
  double median_ms = 0, largest_ms = 0;  ///< processor time of a frame [ms]
  double ns_per_particle = 0;            ///< median time over particles and substeps [ns]
  double compression = 0;                ///< largest mean compression of a frame [-]
  double ratio = 0;                      ///< time of the plain loop over that of this row
};

struct LiquidOptions {
  std::vector<int> sizes{20000, 100000};  ///< numbers of particles, about
  int frames = 90;
  std::function<void(const LiquidRow&)> on_row;
};

/// A block of 1 x 2 x 1 m breaks in a tank of three times its length, with the default substeps, on one thread. The plain loop handles one
/// particle after another, with the same neighbour lists, and gives the same bits, which is checked. Both take turns frame by frame. Throws
/// an Error if a size is below 100 or above 10^7.
std::vector<LiquidRow> measure_liquids(const LiquidOptions& options);

std::string to_json(const std::vector<LiquidRow>& rows);

}  // namespace pliant::bench
