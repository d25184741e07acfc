// The convex hull of points, with faces as polygons. Host only; which points are corners is decided by exact signs.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// A convex polyhedron. Every edge belongs to two faces; corners and faces are numbered in an order that depends on the
/// points' order alone.
struct ConvexHull {
  std::vector<Vec3f> corners;
  /// Corners of each face, counter-clockwise from outside, at least three. Neighbouring triangles that lie in one plane
  /// up to rounding are one face.
  std::vector<std::vector<int>> faces;
  std::vector<Vec3f> normals;  ///< outward unit normal of each face

  /// The faces as triangles: each polygon as a fan about its first corner.
  std::vector<std::array<int, 3>> triangles() const;
};

/// The hull of points; empty if all lie in one plane, exactly. Coordinates are finite. Quickhull (Barber, Dobkin and
/// Huhdanpaa
/// 1996), in which exact signs decide what is outside, so the hull contains every point but for what
/// merging triangles into faces moves it, some roundings of a float.
std::optional<ConvexHull> convex_hull(const std::vector<Vec3f>& points);

}  // namespace pliant
