// Errors in the clusters of an object for which a World rejects it.
#include <set>
#include <string>

#include "inspect/problems.h"

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

}  // namespace

void check_clusters(Problems& problems, const Object& object) {
  Tally outside, repeated, small;
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
  }
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
