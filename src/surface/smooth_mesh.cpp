// Taubin's filter with equal weights of the four neighbours on the faces of the grid's cells.
#include "surface/smooth_mesh.h"

#include <utility>

#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

constexpr int vertices_at_a_time = 4096;

/// Moves each vertex by a share of the way to the mean of its neighbours.
void move_to_mean(const LinkedMesh& mesh, float share, Vertex* to, Executor& executor) {
  for_items(executor, "surface: smoothing", mesh.size, vertices_at_a_time, [&](int v) {
    const Links& links = mesh.links[at(v)];
    const auto neighbour = [&](std::size_t n) { return mesh.vertices[at(links[n])]; };
    const Vertex sum = (neighbour(0) + neighbour(1)) + (neighbour(2) + neighbour(3));
    const Vertex own = mesh.vertices[at(v)];
    to[v] = own + (sum * 0.25f - own) * share;
  });
}

}  // namespace

void smooth(LinkedMesh& mesh, int passes, Executor& executor) {
  // The filter's response to the frequency k (0 to 2) is (1 - k share)(1 - k back); it is 1 again at k = 1/share +
  // 1/back = 0.1.
  constexpr float share = 0.6f, back = -0.628272251f;
  if (passes == 0) return;
  std::unique_ptr<Vertex[]> moved(new Vertex[at(mesh.size)]);
  for (int pass = 0; pass < passes; ++pass)
    for (const float by : {share, back}) {
      move_to_mean(mesh, by, moved.get(), executor);
      std::swap(mesh.vertices, moved);
    }
}

TriangleMesh unlinked(LinkedMesh mesh, Executor& executor) {
  TriangleMesh result{std::vector<Vec3f>(at(mesh.size)), std::move(mesh.triangles)};
  for_items(executor, "surface: mesh", mesh.size, vertices_at_a_time, [&](int v) {
    const Vertex& from = mesh.vertices[at(v)];
    result.positions[at(v)] = {from.x, from.y, from.z};
  });
  return result;
}

}  // namespace pliant::surface
