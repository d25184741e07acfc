// Computes lower bounds of the distance for many cluster pairs at once, on all threads.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/clearance.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

class ClearanceSearch {
 public:
  /// The computation of bounds from vertex distances. Its pieces are the clusters.
  Clearance& clearance() { return clearance_; }
  void resize(std::size_t clusters) { is_placed_.resize(clusters); }

  /// Discards all queries and sets the number of cluster pairs.
  void begin(std::size_t pairs);
  /// Adds a query, at most one a pair: the lower bound of the distance of two clusters, up to `wanted` [m].
  void ask(const ClusterSides& sides, float wanted);
  void answer(Executor& executor, const PairKernels& kernels, const Record* positions);
  /// The answer: a lower bound over the primitives of both clusters, without excluded pairs [m]; < 0 if not queried.
  float of(const ClusterSides& sides) const { return answers_[static_cast<std::size_t>(sides.pair)]; }

 private:
  struct Question {
    int pair, first, second;
    float wanted;
  };

  Clearance clearance_;
  std::vector<char> is_placed_;  ///< for each cluster, 1 if its positions are to be gathered
  std::vector<Question> questions_;
  std::vector<float> answers_;                      ///< answer for each cluster pair [m]
  std::vector<std::vector<std::int32_t>> scratch_;  ///< scratch memory of each task
};

}  // namespace pliant
