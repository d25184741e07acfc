// The cost of a bar of tetrahedra, in lanes and as a plain loop (`pliant bench W2`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// One way to step a bar.
struct SoftBodyRow {
  int cells = 0;  ///< along the bar; a quarter as many across
  int tetrahedra = 0;
  int projections = 0;   ///< constraints
  std::string material;  ///< "edges and volumes", rigid, or "neo-Hookean"
  std::string engine;    ///< "plain loop" (one constraint after another), "pliant" or "two threads"
  int substeps = 0;
  double median_ms = 0;  ///< of a frame: processor time; of two threads, time on the wall [ms]
  double ns = 0;         ///< median over projections of a frame [ns]
  /// Median, over the frames, of the plain loop's time over that of this row; "two threads": one thread's over this.
  double ratio = 0;
  int inverted = 0;      ///< tetrahedra with a volume below 0 after the last frame
  double worst = 0;      ///< smallest volume over the rest volume, in any frame [-]
  double set_up_ms = 0;  ///< processor time to make the World [ms]
};

struct SoftBodyBenchOptions {
  std::vector<int> sizes{40, 80};  ///< cells along the bar, 4 to 400
  int frames = 120;
  std::function<void(const SoftBodyRow&)> on_row;
};

/// A bar of cubic cells of six tetrahedra each, held at one end, swings down under its weight: frames of 1/60 s with 10
/// substeps (edges and volumes) or 20 (neo-Hookean). The ways to step it take turns, frame by frame, and give the same
/// bits, which is checked. Throws an Error if a size is out of range.
std::vector<SoftBodyRow> measure_soft_bodies(const SoftBodyBenchOptions& options);

std::string to_json(const std::vector<SoftBodyRow>& rows);

}  // namespace pliant::bench
