// What it costs that something tears (`pliant bench tears`).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// One object that a blade cuts, beside the same object that is not cut. Times are processor time of one thread.
struct TearRow {
  std::string object;                          ///< "block" or "cloth"
  int cells = 0;                               ///< along each side
  int elements = 0;                            ///< tetrahedra, or triangles
  int substeps = 0;                            ///< per frame
  int cuts = 0;                                ///< frames in which it was cut
  double copies = 0;                           ///< particles that such a frame adds, on average
  double whole_ms = 0, cut_ms = 0;             ///< median frame of the object that is not cut; of the other, when it is
  double ratio = 0;                            ///< of the two, as the median over frames
  double us_per_copy = 0, ns_per_element = 0;  ///< the difference over particles that are added, and over elements
};

struct TearOptions {
  std::vector<int> sizes{12, 24, 40};  ///< cells of a block along each side; a cloth has eight times as many
  int frames = 40;                     ///< in which the blade passes through, of 1/60 s
  std::function<void(const TearRow&)> on_row;
};

/// Cuts nearly incompressible blocks and hanging cloths in two, a little in each frame. Both objects of a row take
/// turns. Throws an Error if a size is not 2 to 60, or if there are no frames.
std::vector<TearRow> measure_tears(const TearOptions& options);

std::string to_json(const std::vector<TearRow>& rows);

}  // namespace pliant::bench
