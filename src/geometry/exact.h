// Signs that rounding cannot change: on which side of a plane a point lies, and whether an edge crosses a triangle.
//
// For audits and inside tests, where one wrong sign is a false alarm or a hole. Nearly all answers come from double
// precision with an error bound; the rest from sums of doubles that are kept without rounding. For hosts only.
#pragma once

#include "pliant/vec3.h"

namespace pliant {

/// The exact sign (-1, 0, 1) of the volume of the tetrahedron a, b, c, d: positive where d is on the side from which a, b, c
/// run counter-clockwise. For all finite floats, subnormal ones too. A filter as in Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates"; the exact part multiplies out instead.
int volume_sign(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d);

/// How an edge and a triangle, both closed, meet.
enum class EdgeTriangle {
  apart,     ///< no point in common
  touching,  ///< common points, but not as below: ends or borders that touch, or all in one plane
  crossing   ///< the inside of the edge passes through the inside of the triangle from one side to the other
};

/// The exact answer for all finite floats; edges and triangles without extent too.
EdgeTriangle how_edge_meets_triangle(const Vec3f (&edge)[2], const Vec3f (&triangle)[3]);

/// Whether the insides of edge p-q and of triangle a, b, c properly cross.
inline bool edge_crosses_triangle(const Vec3f& p, const Vec3f& q, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return how_edge_meets_triangle({p, q}, {a, b, c}) == EdgeTriangle::crossing;
}

}  // namespace pliant
