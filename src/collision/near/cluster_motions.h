// The motion of clusters in a substep: a rigid motion for each, and the residual motion of its vertices.
#pragma once

#include <vector>

#include "collision/broad/bounds.h"
#include "collision/near/bound.h"
#include "collision/near/cluster_layout.h"
#include "parallel/executor.h"

namespace pliant {

class ClusterMotions {
 public:
  ClusterMotions(const PairModel& model, const PairKernels& kernels) : model_(model), kernels_(kernels) {}

  void resize(std::size_t clusters);
  /// Discards the motion of a cluster that was removed or is new.
  void reset(int cluster);

  /// Measures the motion of all clusters in this substep. Returns true if all end positions are finite and below 1e14
  /// m. `order` lists all clusters in use.
  bool measure(Executor& executor, const ClusterLayout& layout, const std::vector<int>& order,
               const PairParticles& particles);
  /// Adds the measured motion to the distance travelled; call it after the substep. `order` lists all clusters in use.
  void advance(const std::vector<int>& order);

  const ClusterMotion& operator[](int cluster) const { return motions_[static_cast<std::size_t>(cluster)]; }
  /// The mean displacement of all dynamic vertices of the cluster's set [m]. Swept boxes are computed in a frame that
  /// moves with it. It is that of the set, so that others, which the set cannot meet, change none of its bits.
  const Vec3f& mean(int cluster) const { return means_[static_cast<std::size_t>(model_.set_of_cluster(cluster))]; }
  /// The box that a cluster sweeps in this substep, in the frame that moves with mean(cluster).
  BoxBounds path_box(int cluster) const;
  /// The largest absolute coordinate of a cluster at the last broad-phase rebuild [m].
  float extent(int cluster) const { return extent_[static_cast<std::size_t>(cluster)]; }

  /// True if no cluster has travelled more than `room` [m] relative to the mean of its set since begin_travel().
  bool stay_within(float room, const std::vector<int>& order) const;
  /// True if a cluster is so far from the origin that its rounding error exceeds what its distance bounds allow for.
  bool has_gone_far() const;
  void begin_travel();
  void keep_extents();
  void keep_extent(int cluster);

 private:
  /// The sum of the displacements of a set's dynamic vertices [m], and their number.
  struct Sum {
    Vec3d of_displacements{};
    double count = 0;
  };

  float travel_next(int cluster) const;
  void find_means(const std::vector<int>& order);

  const PairModel& model_;
  const PairKernels& kernels_;
  std::vector<ClusterMotion> motions_;
  /// Distance that each cluster has travelled relative to mean(), since begin_travel() [m]
  std::vector<float> travel_;
  std::vector<float> extent_;
  std::vector<Sum> sums_;     ///< scratch memory of find_means
  std::vector<Vec3f> means_;  ///< for each set
};

}  // namespace pliant
