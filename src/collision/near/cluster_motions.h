// How clusters move: a rigid motion each, and how far its vertices depart from it.
#pragma once

#include <vector>

#include "collision/broad/bounds.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_layout.h"
#include "parallel/executor.h"

namespace pliant {

class ClusterMotions {
 public:
  ClusterMotions(const PairKernels& kernels, int clusters);

  /// Measures the substep's motion of all clusters. Returns whether every position at its end is finite and below 1e14 m.
  bool measure(Executor& executor, const ClusterLayout& layout, const PairParticles& particles);
  /// After the substep: it has been made.
  void advance();

  const ClusterMotion& operator[](int cluster) const { return motions_[static_cast<std::size_t>(cluster)]; }
  /// The mean displacement of what can be pushed [m]. Boxes are fitted as an observer sees them who moves along with it.
  const Vec3f& mean() const { return mean_; }
  /// A box around the paths of all of a cluster, as that observer sees them.
  BoxBounds path_box(int cluster) const;
  /// The largest coordinate of a cluster at the last broad-phase rebuild [m].
  float extent(int cluster) const { return extent_[static_cast<std::size_t>(cluster)]; }

  /// Whether no cluster travels farther than `room` [m] against the mean of all, since begin_travel().
  bool stay_within(float room) const;
  /// Whether a cluster is so much farther from the origin that its rounding outgrows what bounds allow for.
  bool has_gone_far() const;
  void begin_travel();
  void keep_extents();

 private:
  float travel_next(int cluster) const;

  const PairKernels& kernels_;
  std::vector<ClusterMotion> motions_;
  std::vector<float> travel_;  ///< against the mean of all, since begin_travel() [m]
  std::vector<float> extent_;
  Vec3f mean_{};
};

}  // namespace pliant
