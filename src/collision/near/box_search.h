// Finds pairs of primitives of two clusters whose swept boxes overlap, sixteen boxes against one.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/neighbourhood.h"

namespace pliant {

class BoxSearch {
 public:
  BoxSearch(const PairModel& model, const PairKernels& kernels, const ClusterLayout& layout);

  /// Allocates memory for the primitives of the layout. Call it after the layout changed.
  void fit_to_layout();
  /// Requests boxes for the primitives of these two sides.
  void want(const ClusterSides& sides);
  /// Fits all requested boxes.
  void fit(Executor& executor, const ClusterMotions& motions, const PairParticles& particles);

  /// Scratch memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> batches;
    std::vector<BoxHit> hits;
    std::vector<NearPair> found;
    std::vector<float> value;  ///< bounds of the pairs kept [m]
  };
  /// Finds pairs whose boxes come within `reach` [m], except static pairs and pairs with a common vertex. Result in
  /// scratch.found. `far`: a box around the second cluster.
  void find(const ClusterSides& sides, const BoxBounds& far, float reach, Scratch& scratch);

 private:
  struct Boxes {
    std::vector<float> side[6];    ///< low x, y, z, high x, y, z of each primitive
    std::vector<BoxBounds> batch;  ///< union of sixteen boxes
    std::vector<char> wanted;      ///< of each cluster
    BoxBounds around_sixteen(int first) const;
    BoxRows rows();
  };
  void fit_cluster(int kind, int cluster, const Vec3f& drift, const PairParticles& particles);
  /// The sides of a comparison; `once` if each pair of edges occurs in both orders.
  struct Compared {
    const ClusterElements &rows, &columns;
    bool of_vertices, once;
  };
  static void add_pairs(const Compared& of, const BoxHit* hits, int count, std::vector<NearPair>& found);

  const PairModel& model_;
  const PairKernels& kernels_;
  const ClusterLayout& layout_;
  Boxes boxes_[3];
};

}  // namespace pliant
