// Clusters of shape matching (Mueller, Heidelberger, Teschner, Gross 2005), compiled.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "model/pool.h"
#include "pliant/scene.h"

namespace pliant {

/// A rest position about the cluster's centre of mass, over its size: (x, y, z), then x^2, y^2, z^2, x y, y z, z x less
/// their means. `linear` needs the first three, `quadratic` all nine.
inline constexpr int most_moments = 9;

struct CompiledCluster {
  int first = 0, last = 0;  ///< its members, half-open
  Cluster::Mode mode = Cluster::Mode::rigid;
  bool is_flat = false;  ///< its rest shape has no volume, so none is kept
  Law law = Law::compliant;
  double share = 0;               ///< Cluster::share
  double response = 0;            ///< compliance [s^2], or PBD stiffness k' [-]
  double damping = 0;             ///< [1/s]
  double size = 0;                ///< root mean square distance of its members from their centre [m]
  std::array<double, 6> means{};  ///< of the six products of coordinates
  int basis = 0;                  ///< index in CompiledClusters::bases of a matrix of 3 x 3 or 9 x 9
};

struct ClusterMember {
  int particle = 0;     ///< storage index
  double weight = 0;    ///< share of the cluster's mass
  Vec3<double> rest{};  ///< about the centre of mass, over the size [-]
};

/// A cluster whose rest shape flows: its places are the stretch times those of the start.
struct PlasticCluster {
  int cluster = 0;
  Plasticity law{};
  std::array<float, 9> stretch{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< by rows; its determinant is 1
  std::vector<Vec3<double>> start;                          ///< ClusterMember::rest at the start
  std::vector<Vec3f> given;                                 ///< rest places of the members as the user gave them [m]
};

/// The clusters of an object, by colour; those of one colour share no particle.
struct CompiledClusters {
  std::vector<CompiledCluster> clusters;
  std::vector<ClusterMember> members;        ///< of each cluster in the order of the State
  std::vector<double> bases;                 ///< orthonormal_basis of the moments of each cluster that deforms
  std::vector<std::pair<int, int>> colours;  ///< ranges of clusters, half-open
  bool has_multipliers = false;              ///< a cluster yields, or is damped
  std::vector<PlasticCluster> plastic;
};

/// `place` is that of CompiledObject, `inverse_masses` has those of particles in storage order, `passes` is that of
/// CompileOptions. A particle of infinite mass weighs as much as 10 000 of its cluster.
CompiledClusters compile_clusters(const Object& object, const std::vector<int>& place,
                                  const std::vector<float>& inverse_masses, int passes);

/// Gives a plastic cluster the stretch of its rest shape, and its members the places of that.
void set_stretch(CompiledClusters& clusters, PlasticCluster& plastic, const std::array<float, 9>& stretch);

}  // namespace pliant
