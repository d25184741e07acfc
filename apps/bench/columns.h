// How much denser than at rest columns of liquid are, and how fast they still move, by settings (`pliant bench
// columns`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// One column with one choice of settings. Density errors and speeds are those of the last second.
struct ColumnRow {
  double depth = 0, spacing = 0;  ///< [m]
  int particles = 0;
  int substeps = 0;         ///< per frame
  int iterations = 0;       ///< per substep
  bool is_default = false;  ///< the substeps are those that the engine chose
  double mean = 0,
         largest =
             0;  ///< excess of density over that at rest: on average over frames, and of any particle and frame [-]
  double speed = 0, fastest = 0;  ///< of particles: on average, and of any particle and frame [m/s]
  double height = 0;              ///< by the centre of mass, over that at the start [-]
  double ns = 0;                  ///< median processor time of a frame, over particles, substeps and iterations [ns]
  double ms_per_1000 = 0;         ///< median processor time of a frame for a thousand particles [ms]
};

struct ColumnOptions {
  std::vector<int> depths{50, 200, 500};           ///< [cm]
  std::vector<double> spacings{0.025, 0.05, 0.1};  ///< [m]; only those with at most 100 layers, and at least 8
  std::vector<int> substeps{2, 5, 10, 20, 40};
  std::vector<int> iterations{1, 2, 4};
  int frames = 300;  ///< of 1/60 s, at least 61
  std::function<void(const ColumnRow&)> on_row;
};

/// Lets columns of liquid, eight particles wide, stand in tanks of planes without friction, on one thread. For each
/// depth and spacing, the default substeps with one iteration come first. Throws an Error if a depth is not 1 to 10 000
/// cm or if there are too few frames.
std::vector<ColumnRow> measure_columns(const ColumnOptions& options);

std::string to_json(const std::vector<ColumnRow>& rows);

}  // namespace pliant::bench
