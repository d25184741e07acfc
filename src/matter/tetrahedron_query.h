// Finds the tetrahedron that a place lies in, or the nearest one.
#pragma once

#include <array>
#include <vector>

#include "collision/broad/tree.h"
#include "pliant/vec3.h"

namespace pliant {

struct PlaceInTetrahedron {
  int tetrahedron = 0;  ///< the first of those that are equally near
  /// Barycentric coordinates of the place; negative outside; of its first corner if it is flat.
  std::array<double, 4> weights{};
};

class TetrahedronQuery {
 public:
  /// There is at least one tetrahedron; their corners exist and are finite.
  TetrahedronQuery(const std::vector<Vec3f>& positions, std::vector<std::array<int, 4>> tetrahedra);

  PlaceInTetrahedron nearest(const Vec3f& place) const;
  const std::array<int, 4>& tetrahedron(int t) const { return tetrahedra_[static_cast<std::size_t>(t)]; }

 private:
  std::array<double, 4> weights(int t, const Vec3f& place) const;
  float distance(int t, const Vec3f& place) const;
  Vec3d corner(int t, std::size_t i) const;

  const std::vector<Vec3f>& positions_;
  std::vector<std::array<int, 4>> tetrahedra_;
  Tree<BoxBounds> tree_;
};

}  // namespace pliant
