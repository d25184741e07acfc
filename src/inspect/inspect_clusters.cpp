// Errors in the clusters of an object for which a World rejects it.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "inspect/problems.h"
#include "math/vector.h"
#include "model/cluster_moments.h"

namespace pliant {

namespace {

bool has_twice(const Cluster& cluster) {
  return std::set<int>(cluster.particles.begin(), cluster.particles.end()).size() < cluster.particles.size();
}

void check_rest(Problems& problems, const std::string& name, const Cluster& cluster) {
  if (!cluster.rest.empty() && cluster.rest.size() != cluster.particles.size())
    problems.grave(name,
                   "has " + std::to_string(cluster.rest.size()) + " rest places for " +
                       std::to_string(cluster.particles.size()) + " particles",
                   "give one for each particle, or none");
  for (const Vec3f& place : cluster.rest) require_place(problems, name + ", rest", place);
}

/// True if the rest shape has no volume. Its particles exist.
bool is_flat_at_rest(const Object& object, const Cluster& cluster) {
  std::vector<Vec3d> places;
  Vec3d centre{};
  for (std::size_t i = 0; i < cluster.particles.size(); ++i) {
    const auto particle = static_cast<std::size_t>(cluster.particles[i]);
    places.push_back(convert<double>(cluster.rest.empty() ? object.positions[particle] : cluster.rest[i]));
    centre += (1 / static_cast<double>(cluster.particles.size())) * places.back();
  }
  std::vector<double> moments(9, 0);
  for (const Vec3d& place : places) {
    const double q[3] = {place.x - centre.x, place.y - centre.y, place.z - centre.z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) moments[3 * i + j] += q[i] * q[j];
  }
  return is_flat(moments, 3);
}

/// Clusters whose plasticity does nothing.
struct Elastic {
  Tally flat, rigid;
};

void check_plasticity(Problems& problems, const std::string& name, const Object& object, std::int64_t number,
                      Elastic& elastic) {
  const Cluster& cluster = object.clusters[static_cast<std::size_t>(number)];
  if (!cluster.plasticity) return;
  if (!is_sound(*cluster.plasticity))
    problems.grave(name, "has a plasticity with a number below 0 or not finite", "give numbers of 0 or more");
  const bool has_rest = cluster.rest.empty() || cluster.rest.size() == cluster.particles.size();
  const auto exists = [&](int particle) {
    return particle >= 0 && static_cast<std::size_t>(particle) < object.positions.size();
  };
  if (has_rest && std::all_of(cluster.particles.begin(), cluster.particles.end(), exists) &&
      is_flat_at_rest(object, cluster))
    elastic.flat.add(number);
  const bool is_rigid =
      cluster.stiffness.kind == Stiffness::Kind::pbd ? cluster.stiffness.value >= 1 : cluster.stiffness.value == 0;
  if (is_rigid && (cluster.mode == Cluster::Mode::rigid || cluster.share == 0)) elastic.rigid.add(number);
}

}  // namespace

void check_clusters(Problems& problems, const Object& object) {
  Tally outside, repeated, small;
  Elastic elastic;
  for (std::size_t c = 0; c < object.clusters.size(); ++c) {
    const Cluster& cluster = object.clusters[c];
    const auto number = static_cast<std::int64_t>(c);
    const std::string name = "cluster " + std::to_string(c);
    if (cluster.particles.size() < 2) small.add(number);
    if (has_twice(cluster)) repeated.add(number);
    for (const int p : cluster.particles)
      if (p < 0 || static_cast<std::size_t>(p) >= object.positions.size()) {
        outside.add(number);
        break;
      }
    check_rest(problems, name, cluster);
    require_range(problems, name + ", share", static_cast<double>(cluster.share), 0, 1);
    check_stiffness(problems, name, cluster.stiffness);
    check_plasticity(problems, name, object, number, elastic);
  }
  problems.doubtful(elastic.flat, "cluster", "has a plasticity but is flat, so it stays elastic",
                    "give it particles that are not in one plane");
  problems.doubtful(elastic.rigid, "cluster", "has a plasticity but is rigid, so nothing of it yields",
                    "give it a compliance in s^2, or the mode linear or quadratic");
  problems.grave(small, "cluster", "has fewer than two particles", "give the particles that keep their shape");
  problems.grave(outside, "cluster",
                 "names a particle that does not exist; there are " + std::to_string(object.positions.size()),
                 "indices count from 0");
  problems.grave(repeated, "cluster", "names a particle twice", "name each once");
  if (!object.clusters.empty() && !object.bodies.empty())
    problems.grave("clusters", "are of an object with rigid bodies",
                   "use joints, or an object of its own for the particles");
  if (!object.clusters.empty() && object.fluid)
    problems.grave("clusters", "are of a liquid, which keeps no shape", "leave out the clusters, or the liquid");
}

}  // namespace pliant
