// Taubin's filter with equal weights.
#include "surface/smooth_mesh.h"

namespace pliant::surface {

namespace {

/// The sum of a vertex's neighbours, each counted twice, and their number.
struct Sum {
  Vec3f positions;
  float count = 0;
};

/// Moves each vertex by a share of the way to the mean of its neighbours. An edge has two triangles, so both count each neighbour.
void move_to_mean(TriangleMesh& mesh, float share, std::vector<Sum>& sums) {
  sums.assign(mesh.positions.size(), {});
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      Sum& sum = sums[static_cast<std::size_t>(triangle[i])];
      sum.positions += mesh.positions[static_cast<std::size_t>(triangle[(i + 1) % 3])];
      sum.positions += mesh.positions[static_cast<std::size_t>(triangle[(i + 2) % 3])];
      sum.count += 2;
    }
  for (std::size_t v = 0; v < sums.size(); ++v)
    mesh.positions[v] += (sums[v].positions * (1 / sums[v].count) - mesh.positions[v]) * share;
}

}  // namespace

void smooth(TriangleMesh& mesh, int passes) {
  // The filter's response to the frequency k (0 to 2) is (1 - k share)(1 - k back); it is 1 again at k = 1/share + 1/back = 0.1.
  constexpr float share = 0.5f, back = -0.5263158f;
  std::vector<Sum> sums;
  for (int pass = 0; pass < passes; ++pass) {
    move_to_mean(mesh, share, sums);
    move_to_mean(mesh, back, sums);
  }
}

}  // namespace pliant::surface
