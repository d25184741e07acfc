// Exact geometric predicates: the side of a plane on which a point lies, and edge-triangle intersection.
//
// For checks and inside tests, in which one wrong sign is a false alarm or a hole. Nearly all answers come from double
// precision with an error bound, the rest from exact sums of doubles. Host only.
#pragma once

#include "pliant/vec3.h"

namespace pliant {

/// The exact sign (-1, 0, 1) of the volume of the tetrahedron a, b, c, d: positive if a, b, c appear counter-clockwise
/// from d. Valid for all finite floats, including subnormal ones. Filter as in Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates"; the exact part uses products instead.
int volume_sign(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d);

/// How a closed edge and a closed triangle meet.
enum class EdgeTriangle {
  apart,     ///< edge and triangle have no point in common
  touching,  ///< common points, but not a crossing: ends or borders touch, or all is coplanar
  crossing   ///< the interior of the edge crosses the interior of the triangle
};

/// Decides how an edge meets a triangle. Exact for all finite floats, including degenerate edges and triangles.
EdgeTriangle how_edge_meets_triangle(const Vec3f (&edge)[2], const Vec3f (&triangle)[3]);

/// True if the interiors of edge p-q and triangle a, b, c cross transversally.
inline bool edge_crosses_triangle(const Vec3f& p, const Vec3f& q, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return how_edge_meets_triangle({p, q}, {a, b, c}) == EdgeTriangle::crossing;
}

}  // namespace pliant
