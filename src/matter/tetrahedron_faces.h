// The faces of tetrahedra, wound alike.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "math/vector.h"

namespace pliant {

/// The four triangles of a tetrahedron of positive volume, counter-clockwise seen from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> tetrahedron_faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

inline std::array<int, 3> face_of(const std::array<int, 4>& t, std::size_t face) {
  const auto& [a, b, c] = tetrahedron_faces[face];
  return {t[a], t[b], t[c]};
}

inline bool has_corner(const std::array<int, 4>& t, int particle) {
  return t[0] == particle || t[1] == particle || t[2] == particle || t[3] == particle;
}

/// The ways from the first corner of a tetrahedron to the others.
inline std::array<Vec3d, 3> ways_of(const std::array<int, 4>& t, const std::vector<Vec3f>& positions) {
  const auto at = [&](std::size_t i) { return convert<double>(positions[static_cast<std::size_t>(t[i])]); };
  return {at(1) - at(0), at(2) - at(0), at(3) - at(0)};
}

/// A tetrahedron with its last corners exchanged if its volume is negative.
inline std::array<int, 4> wound(std::array<int, 4> t, const std::vector<Vec3f>& positions) {
  const auto [a, b, c] = ways_of(t, positions);
  if (dot(cross(a, b), c) < 0) std::swap(t[2], t[3]);
  return t;
}

}  // namespace pliant
