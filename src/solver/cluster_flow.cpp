// Plastic flow of clusters: their rest shapes take on what they are stretched and sheared by.
#include <algorithm>
#include <array>
#include <cmath>

#include "math/functions.h"
#include "math/plastic_strain.h"
#include "model/cluster_moments.h"
#include "solver/clusters.h"

namespace pliant {

namespace {

/// The deformation of a cluster's present rest shape, F = sum w (x - c) q^T (sum w q q^T)^-1. All zero if that shape
/// has no volume.
Matrix3d deformation(const CompiledClusters& clusters, const CompiledCluster& cluster, const SweepArguments& a) {
  const Record& origin = a.positions[clusters.members[cluster.first].particle];
  const auto place = [&](int particle) {
    const Record &p = a.positions[particle], &d = a.displacements[particle];
    return Vec3d{(double(p.x) - origin.x) + d.x, (double(p.y) - origin.y) + d.y, (double(p.z) - origin.z) + d.z};
  };
  Vec3d centre{};
  for (int m = cluster.first; m < cluster.last; ++m)
    centre += clusters.members[m].weight * place(clusters.members[m].particle);
  Matrix3d sums;
  std::vector<double> moments(9, 0);
  for (int m = cluster.first; m < cluster.last; ++m) {
    const ClusterMember& member = clusters.members[m];
    const Vec3d r = (member.weight / cluster.size) * (place(member.particle) - centre);
    const double of_r[3] = {r.x, r.y, r.z}, q[3] = {member.rest.x, member.rest.y, member.rest.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        sums[3 * i + j] += of_r[i] * q[j];
        moments[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(j)] += member.weight * q[i] * q[j];
      }
  }
  if (is_flat(moments, 3)) return {};
  const std::vector<double> inverse = inverse_of_moments(std::move(moments), 3);
  Matrix3d by;
  std::copy(inverse.begin(), inverse.end(), by.elements);
  return product(sums, by);
}

}  // namespace

void let_cluster_flow(CompiledClusters& clusters, PlasticCluster& plastic, const SweepArguments& a, double h) {
  const CompiledCluster& cluster = clusters.clusters[plastic.cluster];
  if (!(cluster.size > 0)) return;
  const double rate = static_cast<double>(plastic.law.rate), share = rate > 0 ? -expm1(-rate * h) : 1;
  Matrix3d by, stretch;
  if (!flow_of(deformation(clusters, cluster, a), static_cast<double>(plastic.law.yield), share, by)) return;
  for (int i = 0; i < 9; ++i) stretch[i] = static_cast<double>(plastic.stretch[static_cast<std::size_t>(i)]);
  stretch = product(by, stretch);
  if (limit_of(stretch, static_cast<double>(plastic.law.most), by)) stretch = product(stretch, by);
  if (!(std::isfinite(determinant(stretch)) && !is_pressed_flat(stretch))) return;
  std::array<float, 9> out;
  for (int i = 0; i < 9; ++i) out[static_cast<std::size_t>(i)] = static_cast<float>(stretch[i]);
  set_stretch(clusters, plastic, out);
}

}  // namespace pliant
