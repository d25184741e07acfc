#include "model/compiled_clusters.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "math/functions.h"
#include "model/cluster_moments.h"
#include "model/stiffness.h"

namespace pliant {

namespace {

/// The clusters of each colour: the first that none of a cluster's particles has yet.
std::vector<std::vector<int>> colour(const std::vector<Cluster>& clusters, std::size_t particles) {
  std::vector<std::vector<int>> by_colour;
  std::vector<std::vector<char>> taken(particles);  // by particle and colour
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const auto is_taken = [&](std::size_t at) {
      return std::any_of(clusters[c].particles.begin(), clusters[c].particles.end(), [&](int p) {
        const std::vector<char>& of = taken[static_cast<std::size_t>(p)];
        return at < of.size() && of[at] != 0;
      });
    };
    std::size_t at = 0;
    while (is_taken(at)) ++at;
    if (by_colour.size() <= at) by_colour.resize(at + 1);
    by_colour[at].push_back(static_cast<int>(c));
    for (const int p : clusters[c].particles) {
      std::vector<char>& of = taken[static_cast<std::size_t>(p)];
      if (of.size() <= at) of.resize(at + 1, 0);
      of[at] = 1;
    }
  }
  return by_colour;
}

/// Sets weights that sum to one.
void set_weights(const std::vector<float>& inverse_masses, std::vector<ClusterMember>& members) {
  constexpr double fixed_over_dynamic = 1e4;
  double dynamic = 0, all = 0;
  const auto inverse_mass = [&](const ClusterMember& m) {
    return static_cast<double>(inverse_masses[static_cast<std::size_t>(m.particle)]);
  };
  for (const ClusterMember& m : members)
    if (inverse_mass(m) > 0) dynamic += 1 / inverse_mass(m);
  const double fixed = dynamic > 0 ? fixed_over_dynamic * dynamic : 1;
  for (ClusterMember& m : members) all += m.weight = inverse_mass(m) > 0 ? 1 / inverse_mass(m) : fixed;
  for (ClusterMember& m : members) m.weight /= all;
}

/// Moves the rest shape to its centre of mass, and divides it by its size, which it returns.
double normalise_rest(std::vector<ClusterMember>& members) {
  Vec3d centre{};
  for (const ClusterMember& m : members) centre += m.weight * m.rest;
  double squares = 0;
  for (ClusterMember& m : members) {
    m.rest -= centre;
    squares += m.weight * dot(m.rest, m.rest);
  }
  const double size = std::sqrt(squares);
  for (ClusterMember& m : members) m.rest = m.rest * (size > 0 ? 1 / size : 0);
  return size;
}

std::vector<ClusterMember> members_of(const Object& object, const Cluster& cluster, const std::vector<int>& place) {
  std::vector<ClusterMember> members;
  for (std::size_t i = 0; i < cluster.particles.size(); ++i) {
    const auto particle = static_cast<std::size_t>(cluster.particles[i]);
    const Vec3f& rest = cluster.rest.empty() ? object.positions[particle] : cluster.rest[i];
    members.push_back({place[particle], 0, convert<double>(rest)});
  }
  std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.particle < b.particle; });
  return members;
}

std::span<const ClusterMember> members_of(const CompiledClusters& clusters, const CompiledCluster& cluster) {
  return std::span(clusters.members)
      .subspan(static_cast<std::size_t>(cluster.first), static_cast<std::size_t>(cluster.last - cluster.first));
}

/// The orthonormal basis of the moments sum w q q^T of the rest shape, n x n. Sets what else of a cluster follows from
/// them.
std::vector<double> basis_of(std::span<const ClusterMember> members, int n, CompiledCluster& cluster) {
  cluster.means = {};
  for (const ClusterMember& m : members) {
    const std::array<double, 6> products = products_of(m.rest);
    for (std::size_t i = 0; i < 6; ++i) cluster.means[i] += m.weight * products[i];
  }
  std::vector<double> sums(static_cast<std::size_t>(n) * n, 0);
  for (const ClusterMember& m : members) {
    const std::array<double, most_moments> q = moments_at(m.rest, cluster.means);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sums[static_cast<std::size_t>(i) * n + j] += m.weight * q[i] * q[j];
  }
  cluster.is_flat = is_flat(sums, n);
  return orthonormal_basis(sums, n);
}

/// Adds the basis of the last cluster, if its mode needs them.
void add_moments(CompiledClusters& out) {
  CompiledCluster& cluster = out.clusters.back();
  const int n = moments_of(cluster.mode);
  if (n == 0) return;
  cluster.basis = static_cast<int>(out.bases.size());
  const std::vector<double> basis = basis_of(members_of(out, cluster), n, cluster);
  out.bases.insert(out.bases.end(), basis.begin(), basis.end());
}

/// Notes the last cluster as plastic.
void add_plastic(const Object& object, const Cluster& from, const std::vector<int>& place, CompiledClusters& out) {
  if (!from.plasticity) return;
  PlasticCluster plastic;
  plastic.cluster = static_cast<int>(out.clusters.size()) - 1;
  plastic.law = *from.plasticity;
  for (const ClusterMember& member : members_of(out, out.clusters.back())) plastic.start.push_back(member.rest);
  for (const ClusterMember& member : members_of(object, from, place))
    plastic.given.push_back(convert<float>(member.rest));
  out.plastic.push_back(std::move(plastic));
}

}  // namespace

CompiledClusters compile_clusters(const Object& object, const std::vector<int>& place,
                                  const std::vector<float>& inverse_masses, int passes) {
  CompiledClusters out;
  for (const std::vector<int>& of_colour : colour(object.clusters, object.positions.size())) {
    const int first = static_cast<int>(out.clusters.size());
    for (const int c : of_colour) {
      const Cluster& from = object.clusters[static_cast<std::size_t>(c)];
      std::vector<ClusterMember> members = members_of(object, from, place);
      set_weights(inverse_masses, members);
      CompiledCluster to;
      to.size = normalise_rest(members);
      to.mode = from.mode;
      to.share = static_cast<double>(from.share);
      const bool is_pbd = from.stiffness.kind == Stiffness::Kind::pbd;
      const double value = static_cast<double>(from.stiffness.value);
      to.law = is_pbd ? Law::pbd : from.stiffness.damping > 0 ? Law::damped : Law::compliant;
      to.response = is_pbd ? stiffness_per_projection(value, passes) : value;
      to.damping = is_pbd ? 0 : static_cast<double>(from.stiffness.damping);
      out.has_multipliers = out.has_multipliers || (!is_pbd && to.response > 0);
      to.first = static_cast<int>(out.members.size());
      out.members.insert(out.members.end(), members.begin(), members.end());
      to.last = static_cast<int>(out.members.size());
      out.clusters.push_back(to);
      add_moments(out);
      add_plastic(object, from, place, out);
    }
    out.colours.emplace_back(first, static_cast<int>(out.clusters.size()));
  }
  return out;
}

void set_stretch(CompiledClusters& clusters, PlasticCluster& plastic, const std::array<float, 9>& stretch) {
  plastic.stretch = stretch;
  CompiledCluster& cluster = clusters.clusters[static_cast<std::size_t>(plastic.cluster)];
  const std::array<double, 9> s = {stretch[0], stretch[1], stretch[2], stretch[3], stretch[4],
                                   stretch[5], stretch[6], stretch[7], stretch[8]};
  for (std::size_t i = 0; i < plastic.start.size(); ++i) {
    const Vec3d& q = plastic.start[i];
    clusters.members[static_cast<std::size_t>(cluster.first) + i].rest = {s[0] * q.x + s[1] * q.y + s[2] * q.z,
                                                                          s[3] * q.x + s[4] * q.y + s[5] * q.z,
                                                                          s[6] * q.x + s[7] * q.y + s[8] * q.z};
  }
  const int n = moments_of(cluster.mode);
  if (n == 0) return;
  const std::vector<double> basis = basis_of(members_of(clusters, cluster), n, cluster);
  std::copy(basis.begin(), basis.end(), clusters.bases.begin() + cluster.basis);
}

}  // namespace pliant
