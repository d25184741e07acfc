// Asks for the clearance of many pairs of clusters at once, on all threads.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/clearance.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

class ClearanceSearch {
 public:
  ClearanceSearch(Clearance clearance, int clusters)
      : clearance_(std::move(clearance)), is_placed_(static_cast<std::size_t>(clusters)) {}

  /// Forgets all questions; there are so many pairs of clusters now.
  void begin(std::size_t pairs);
  /// Asks for the clearance of two clusters up to `wanted` [m], unless it was asked for already.
  void ask(const ClusterSides& sides, float wanted);
  void answer(Executor& executor, const PairKernels& kernels, const Record* positions);
  /// No two primitives of the two clusters are nearer, static pairs and common vertices left aside [m]; below 0: was not asked.
  float of(const ClusterSides& sides) const { return answers_[static_cast<std::size_t>(sides.pair)]; }

 private:
  struct Question {
    int pair, first, second;
    float wanted;
  };

  Clearance clearance_;
  std::vector<char> is_placed_;  ///< clusters
  std::vector<Question> questions_;
  std::vector<float> answers_;                      ///< of each pair of clusters
  std::vector<std::vector<std::int32_t>> scratch_;  ///< of each task
};

}  // namespace pliant
