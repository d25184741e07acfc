// Meshes so far from the origin that floats are coarse compared with their edges.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// How rounding to float changes the edges of a mesh.
struct Rounding {
  double distance = 0;   ///< largest coordinate, in the unit of the file
  double mean_edge = 0;  ///< mean length of the edges, as they were rounded

  /// Floats are 6e-8 to 1.2e-7 of the distance apart: here about 1 % of an edge.
  bool is_noticeable() const { return mean_edge > 0 && distance > 1e5 * mean_edge; }
  /// Here about 10 % of an edge: the shape is lost, and tetrahedra become flat.
  bool is_too_coarse() const { return mean_edge > 0 && distance > 1e6 * mean_edge; }
  /// "lies 500000 from the origin, where floats are 0.031 apart, 25 % of its mean edge"
  std::string in_words() const;
};

inline constexpr const char* move_nearer = "move it to the origin before it is exported";

/// Of the edges between all corners of each cell, which are triangles or tetrahedra.
template <class Cell>
Rounding rounding_of(const std::vector<Vec3f>& positions, const std::vector<Cell>& cells) {
  const auto at = [&](int i) {
    const Vec3f& p = positions[static_cast<std::size_t>(i)];
    return Vec3d{p.x, p.y, p.z};
  };
  Rounding result;
  for (const Vec3f& p : positions)
    for (const float x : {p.x, p.y, p.z})
      result.distance = std::max(result.distance, std::fabs(static_cast<double>(x)));
  std::size_t edges = 0;
  for (const Cell& cell : cells)
    for (std::size_t i = 0; i < cell.size(); ++i)
      for (std::size_t j = 0; j < i; ++j, ++edges)
        result.mean_edge += std::sqrt(length_squared(at(cell[i]) - at(cell[j])));
  result.mean_edge /= static_cast<double>(std::max<std::size_t>(edges, 1));
  return result;
}

}  // namespace pliant
