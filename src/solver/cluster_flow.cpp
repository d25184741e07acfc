// Plastic flow of clusters: their rest shapes take on what they are stretched and sheared by.
#include <algorithm>
#include <array>
#include <cmath>

#include "math/functions.h"
#include "math/isochoric_strain.h"
#include "model/cluster_moments.h"
#include "solver/clusters.h"

namespace pliant {

namespace {

using Vec3d = Vec3<double>;

/// Permanent strain beyond which nothing flows: bars 4.5 times as long.
constexpr double largest_permanent = 1.5;

/// The deformation of a cluster's present rest shape, F = sum w (x - c) q^T (sum w q q^T)^-1. All zero if that shape has no volume.
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

/// True if a deformation leaves less than a thousandth in one direction, or inverts: its strain in that direction would be rounding.
bool is_pressed_flat(const Matrix3d& f) {
  double squares = 0;
  for (const double element : f.elements) squares += element * element;
  constexpr double thinnest = 1e-3;
  const double mean = squares / 3;
  return !(determinant(f) > thinnest * mean * sqrt(mean));
}

}  // namespace

void let_cluster_flow(CompiledClusters& clusters, PlasticCluster& plastic, const SweepArguments& a, double h) {
  const CompiledCluster& cluster = clusters.clusters[plastic.cluster];
  if (!(cluster.size > 0)) return;
  const Matrix3d f = deformation(clusters, cluster, a);
  const double yield = static_cast<double>(plastic.law.yield), rate = static_cast<double>(plastic.law.rate);
  if (is_pressed_flat(f) || is_surely_below(f, yield)) return;
  const IsochoricStrain strain(f);
  const double equivalent = strain.equivalent();
  if (!(equivalent > yield) || !(equivalent < 1e30)) return;
  const double share = (rate > 0 ? -expm1(-rate * h) : 1) * (1 - yield / equivalent);
  Matrix3d stretch;
  for (int i = 0; i < 9; ++i) stretch[i] = static_cast<double>(plastic.stretch[static_cast<std::size_t>(i)]);
  stretch = product(strain.power(share), stretch);
  const double most = min(static_cast<double>(plastic.law.most), largest_permanent);
  if (!is_surely_below(stretch, most)) {
    const IsochoricStrain of(stretch);
    const double size = of.equivalent();
    if (size > most) stretch = product(stretch, of.power(most / size - 1));
  }
  if (!(std::isfinite(determinant(stretch)) && !is_pressed_flat(stretch))) return;
  std::array<float, 9> out;
  for (int i = 0; i < 9; ++i) out[static_cast<std::size_t>(i)] = static_cast<float>(stretch[i]);
  set_stretch(clusters, plastic, out);
}

}  // namespace pliant
