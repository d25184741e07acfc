// Finds the pairs of two clusters whose boxes around the substep's paths come near, sixteen boxes against one.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/near/neighbourhood.h"

namespace pliant {

class BoxSearch {
 public:
  BoxSearch(const PairModel& model, const PairKernels& kernels, const ClusterLayout& layout);

  /// Boxes of what these sides compare are to be fitted.
  void want(const ClusterSides& sides);
  /// Fits all wanted boxes.
  void fit(Executor& executor, const ClusterMotions& motions, const PairParticles& particles);

  /// Memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> batches;
    std::vector<BoxHit> hits;
    std::vector<NearPair> found;
    std::vector<float> value;  ///< of those that are kept [m]
  };
  /// Into scratch.found: pairs whose boxes come within `reach` [m], without those that share a vertex and static pairs. `far`: a box
  /// around the second cluster.
  void find(const ClusterSides& sides, const BoxBounds& far, float reach, Scratch& scratch);

 private:
  struct Boxes {
    std::vector<float> side[6];    ///< low x, y, z, high x, y, z of each element
    std::vector<BoxBounds> batch;  ///< of sixteen
    std::vector<char> wanted;      ///< clusters
    BoxBounds at(int i) const;
    BoxRows rows();
  };
  void fit_cluster(int kind, int cluster, const Vec3f& drift, const PairParticles& particles);
  void add_pair(bool of_vertices, std::int32_t a, std::int32_t b, std::vector<NearPair>& found) const;

  const PairModel& model_;
  const PairKernels& kernels_;
  const ClusterLayout& layout_;
  Boxes boxes_[3];
};

}  // namespace pliant
