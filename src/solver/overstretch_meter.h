// The overstretch of a frame: 99th percentile and maximum over all distance constraints, exactly.
//
// Only the constraints above a threshold are listed, about two in a hundred, and counted in a histogram, which tells
// where the percentile is. The threshold follows from the frame before; it saves work and changes no figure, because
// the search is repeated with a lower one if it found too few.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/report.h"
#include "solver/lengths.h"
#include "solver/workspace.h"

namespace pliant {

/// What a measurement reads: the State at the end of a frame, and the multipliers of its last substep.
struct MeasuredFrame {
  const Model& model;
  const State& state;
  const Workspace& workspace;
  const LengthKernels& kernels;
};

class OverstretchMeter {
 public:
  /// Measures all objects on the executor's threads, or, if it is null, on the calling one. Overstretch::object is the
  /// number in the model.
  Overstretch measure(const MeasuredFrame& frame, Executor* executor);

 private:
  void list_tasks(const Model& model);
  /// Lists the constraints above the threshold. Returns their number.
  std::size_t find(const MeasuredFrame& frame, Executor* executor);
  void find_in(const MeasuredFrame& frame, int task);
  /// Counts the constraints that were found, and stores the largest overstretch, the first of equal ones.
  void count(const MeasuredFrame& frame, Overstretch& into);
  /// The bin of the value with this rank. Changes the rank to that within the bin; 1 is the largest.
  int bin_of_rank(std::size_t& rank) const;
  float value_of_rank(std::size_t rank) const;
  float next_threshold(std::size_t beyond, std::size_t found) const;

  static constexpr int bins = 512;
  float above_ = 0.01f;                          ///< the threshold
  std::vector<Task> tasks_;                      ///< each LengthRange of each object
  std::vector<std::vector<FoundLength>> found_;  ///< by task
  std::array<int, bins> counts_{};               ///< constraints that were found, by bin_of()
};

}  // namespace pliant
