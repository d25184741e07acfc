#include "matter/closed_query.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "collision/fields/distance_grid.h"
#include "pliant/error.h"

namespace pliant {

MeshQuery query_of_closed(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f& p = mesh.positions[i];
    if (!(std::abs(p.x) < 1e15f && std::abs(p.y) < 1e15f && std::abs(p.z) < 1e15f))
      throw Error({.element = "vertex " + std::to_string(i)}, "is not finite, or beyond 1e15 m", "give a place");
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int corner : mesh.triangles[t])
      if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.positions.size())
        throw Error({.element = "triangle " + std::to_string(t)}, "uses a vertex that does not exist",
                    "indices count from 0");
  require_closed(mesh.triangles, static_cast<int>(mesh.positions.size()));
  return {mesh.positions, mesh.triangles};
}

}  // namespace pliant
