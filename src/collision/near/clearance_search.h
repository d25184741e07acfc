// Computes lower bounds of the distance for many cluster pairs at once, on all threads.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/clearance.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

class ClearanceSearch {
 public:
  /// The bounds from vertex distances; its pieces are the clusters.
  Clearance& clearance() { return clearance_; }
  void resize(std::size_t clusters) { is_placed_.resize(clusters); }

  /// Clears all queries and sets the number of cluster pairs.
  void begin(std::size_t pairs);
  /// Queries the lower bound of two clusters up to `wanted` [m], once for each pair.
  void ask(const ClusterSides& sides, float wanted);
  void answer(Executor& executor, const PairKernels& kernels, const Record* positions);
  /// Lower bound of the distance of two primitives, except static pairs and common vertices [m]; < 0 if not queried.
  float of(const ClusterSides& sides) const { return answers_[static_cast<std::size_t>(sides.pair)]; }

 private:
  struct Question {
    int pair, first, second;
    float wanted;
  };

  Clearance clearance_;
  std::vector<char> is_placed_;  ///< of each cluster
  std::vector<Question> questions_;
  std::vector<float> answers_;                      ///< one for each cluster pair
  std::vector<std::vector<std::int32_t>> scratch_;  ///< one for each task
};

}  // namespace pliant
