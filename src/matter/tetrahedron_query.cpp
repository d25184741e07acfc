#include "matter/tetrahedron_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/triangle.h"

namespace pliant {

TetrahedronQuery::TetrahedronQuery(const std::vector<Vec3f>& positions, std::vector<std::array<int, 4>> tetrahedra)
    : positions_(positions), tetrahedra_(std::move(tetrahedra)) {
  std::vector<BoxBounds> boxes;
  boxes.reserve(tetrahedra_.size());
  for (const auto& t : tetrahedra_) {
    Vec3f corners[4];
    for (std::size_t i = 0; i < 4; ++i) corners[i] = positions_[static_cast<std::size_t>(t[i])];
    boxes.push_back(BoxBounds::of(corners, 4));
  }
  tree_.build(boxes);
}

Vec3d TetrahedronQuery::corner(int t, std::size_t i) const {
  return convert<double>(positions_[static_cast<std::size_t>(tetrahedron(t)[i])]);
}

std::array<double, 4> TetrahedronQuery::weights(int t, const Vec3f& place) const {
  const Vec3d a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0), c = corner(t, 3) - corner(t, 0),
              p = convert<double>(place) - corner(t, 0);
  const double six = dot(cross(a, b), c), edges = std::sqrt(dot(a, a) * dot(b, b) * dot(c, c));
  if (!(std::fabs(six) > 1e-6 * edges)) return {1, 0, 0, 0};
  const double wa = dot(cross(b, c), p) / six, wb = dot(cross(c, a), p) / six, wc = dot(cross(a, b), p) / six;
  return {1 - wa - wb - wc, wa, wb, wc};
}

/// How far a place is from a tetrahedron; 0 inside.
float TetrahedronQuery::distance(int t, const Vec3f& place) const {
  const std::array<double, 4> inside = weights(t, place);
  if (std::all_of(inside.begin(), inside.end(), [](double weight) { return weight >= 0; }) && inside[0] < 1) return 0;
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t left_out = 0; left_out < 4; ++left_out)
    squared = std::min(squared, closest_on_triangle(convert<double>(place), corner(t, (left_out + 1) % 4),
                                                    corner(t, (left_out + 2) % 4), corner(t, (left_out + 3) % 4))
                                    .distance_squared);
  return static_cast<float>(std::sqrt(squared));
}

PlaceInTetrahedron TetrahedronQuery::nearest(const Vec3f& place) const {
  const int found = tree_.closest(place, 3e38f, [&](int t) { return distance(t, place); }).first;
  return {found, weights(found, place)};
}

}  // namespace pliant
