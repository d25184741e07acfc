// A cloth that falls on falling bodies, against both apart: what contact between them costs, and crossings by exact
// signs (`pliant bench covered`).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant::bench {

/// A level cloth of 2 m and n x n vertices over falling bodies of six shapes, above a plane.
struct Covered {
  Object cloth, bodies;
};

Covered make_covered(int size, int bodies);

struct CoveredRow {
  std::string what;  ///< "together", "cloth alone" or "bodies alone"
  int size = 0, bodies = 0, frames = 0;
  double mean_ms = 0, median_ms = 0, largest_ms = 0;  ///< processor time of one thread a frame [ms]
  int worst_crossings = 0;                            ///< most edges through triangles of the other side after a frame
  int frames_with_crossings = 0;
  int unnamed = 0;   ///< frames with crossings of bodies that the Report does not name
  double ratio = 0;  ///< of the medians: this over cloth and bodies alone together
};

struct CoveredOptions {
  std::vector<int> sizes{100};
  int bodies = 100, frames = 300;
  std::function<void(const CoveredRow&)> on_row;
};

/// Measures all three rows in turn, frame by frame. Throws an Error if a size is outside 2..1000 or there are no
/// frames.
std::vector<CoveredRow> measure_covered(const CoveredOptions& options);

std::string to_json(const std::vector<CoveredRow>& rows);

}  // namespace pliant::bench
