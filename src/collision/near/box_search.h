// Finds pairs of primitives of two clusters whose swept boxes overlap: sixteen boxes against one at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/neighbourhood.h"
#include "model/pool.h"

namespace pliant {

class BoxSearch {
 public:
  BoxSearch(const PairModel& model, const PairKernels& kernels, const ClusterLayout& layout);

  /// Allocates memory for the primitives of the layout; call it after the layout changed.
  void fit_to_layout();
  /// Requests swept boxes of the primitives on these two sides.
  void want(const ClusterSides& sides);
  /// Computes all requested boxes.
  void fit(Executor& executor, const ClusterMotions& motions, const PairParticles& particles);

  /// A pair that is kept in a near list.
  struct Kept {
    std::int32_t number;  ///< index of the pair found
    std::int32_t interval;
    float value;  ///< distance bound [m]
  };
  /// Scratch memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> batches;
    std::vector<BoxHit> hits;
    /// The pairs found, sixteen a block; unused lanes of the last one repeat a pair.
    AlignedVector<PairStencils> blocks;
    int found = 0;  ///< number of pairs found
    std::vector<Kept> kept;
  };
  /// Writes to scratch.blocks the pairs whose boxes come within `reach` [m], except static pairs and pairs with a
  /// common vertex. `far` encloses the second cluster.
  void find(const ClusterSides& sides, const BoxBounds& far, float reach, Scratch& scratch);

 private:
  struct Boxes {
    AlignedVector<float> side[6];  ///< boxes of all primitives by coordinate: low x, y, z, high x, y, z
    std::vector<BoxBounds> batch;  ///< for each sixteen primitives, the union of their boxes
    std::vector<char> wanted;      ///< for each cluster, 1 if its boxes are requested
    BoxBounds around_sixteen(int first) const;
    BoxRows rows();
  };
  void fit_cluster(int kind, int cluster, const Vec3f& drift, const PairParticles& particles);
  /// The two sides of a comparison; `once` is true if each pair of edges would otherwise be found in both orders.
  struct Compared {
    const ClusterElements &rows, &columns;
    bool of_vertices, once;
  };
  static void add_pairs(const Compared& of, const BoxHit* hits, int count, Scratch& scratch);
  static void pad(Scratch& scratch);

  const PairModel& model_;
  const PairKernels& kernels_;
  const ClusterLayout& layout_;
  Boxes boxes_[3];
};

}  // namespace pliant
