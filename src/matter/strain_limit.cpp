#include "matter/strain_limit.h"

#include <algorithm>

#include "math/vector.h"
#include "pliant/error.h"

namespace pliant {

ConstraintGroup limit_edges(const std::vector<Vec3f>& positions, std::vector<std::array<int, 2>> edges,
                            const StrainLimit& limit, const std::string& object) {
  const bool in_range = limit.least >= 0 && limit.least <= 1 && limit.most >= 1 && limit.most <= 1e6f;
  if (!in_range)
    throw Error({.object = object, .element = "strain_limit"},
                "is " + std::to_string(limit.least) + " to " + std::to_string(limit.most),
                "give the least length over that at rest, 0 to 1, and the greatest, 1 or more");
  for (std::array<int, 2>& edge : edges) std::sort(edge.begin(), edge.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  ConstraintGroup group;
  group.type = "distance_limit";
  for (const std::array<int, 2>& edge : edges) {
    const Vec3d a = convert<double>(positions[static_cast<std::size_t>(edge[0])]),
                b = convert<double>(positions[static_cast<std::size_t>(edge[1])]);
    const double rest = length(b - a);
    group.particles.insert(group.particles.end(), {edge[0], edge[1]});
    group.rest.push_back(static_cast<float>(rest * static_cast<double>(limit.most)));
    group.rest.push_back(static_cast<float>(rest * static_cast<double>(limit.least)));
  }
  return group;
}

}  // namespace pliant
