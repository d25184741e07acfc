#include "topology/folds.h"

#include <cmath>

namespace pliant {

namespace {

constexpr double cosine_of_a_degree = 0.99984769515639;

/// The part of a triangle's height that is perpendicular to the edge, from the edge to the opposite corner.
Vec3d height_over(const Vec3d& a, const Vec3d& b, const Vec3d& corner) {
  const Vec3d along = b - a, to = corner - a;
  return to - along * (dot(to, along) / length_squared(along));
}

}  // namespace

std::vector<int> folded_edges(const std::vector<Vec3f>& positions, const std::vector<Edge>& edges) {
  const auto at = [&](int vertex) { return convert<double>(positions[static_cast<std::size_t>(vertex)]); };
  std::vector<int> folded;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    if (!edge.is_inner()) continue;
    const Vec3d a = at(edge.a), b = at(edge.b);
    const Vec3d p = height_over(a, b, at(edge.opposites[0])), q = height_over(a, b, at(edge.opposites[1]));
    const double lengths = std::sqrt(length_squared(p) * length_squared(q));
    // `lengths` is NaN if the edge has no length, and zero if a triangle has no area.
    if (lengths > 0 && dot(p, q) > cosine_of_a_degree * lengths) folded.push_back(static_cast<int>(i));
  }
  return folded;
}

}  // namespace pliant
