// Closest points of triangles, segments and points; a triangle's area, normal and volume.
//
// Robust for degenerate input: the usual case distinctions divide by areas and determinants, which vanish for slivers
// and parallel edges, exactly where cloth makes contact. Here each candidate (interior, each edge, each end) gives a
// point on the primitive despite rounding, and the nearest wins. A tiny determinant only spoils its own candidate.
// Branch-free, so R may be float, double or Wide. Ties go to the candidate named first.
//
// The cost: distances are accurate to rounding, but positions only to its square
// root, because a distance is flat near its minimum. In float the direction between
// closest points may err by a thousandth of a radian where two candidates nearly tie.
#pragma once

#include "math/vector.h"

namespace pliant {

namespace detail {

/// Lower bound of divisors, the least normal float; 0 divided by it is 0.
template <class R>
PLIANT_HD R least_divisor() {
  return R(1.17549435e-38f);
}

template <class R>
PLIANT_HD R to_unit_interval(const R& t) {
  return clamp(t, R(0), R(1));
}

}  // namespace detail

/// The t in [0, 1] for which a + t (b - a) is closest to p; 0 if a = b.
template <class R>
PLIANT_HD R closest_on_segment(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b) {
  const Vec3<R> edge = b - a;
  return detail::to_unit_interval(dot(p - a, edge) / max(length_squared(edge), detail::least_divisor<R>()));
}

/// The point of a triangle closest to a given point.
template <class R>
struct ClosestOnTriangle {
  Vec3<R> point;       ///< weights.x a + weights.y b + weights.z c [m]
  Vec3<R> weights;     ///< barycentric: each in [0, 1], their sum 1 within rounding
  R distance_squared;  ///< squared distance to the given point [m^2]
};

namespace detail {

template <class R>
PLIANT_HD ClosestOnTriangle<R> triangle_candidate(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b,
                                                  const Vec3<R>& c, const Vec3<R>& weights) {
  // The offset from a is computed first, so that a small triangle far from the origin keeps its precision.
  const Vec3<R> offset = weights.y * (b - a) + weights.z * (c - a);
  return {a + offset, weights, length_squared((p - a) - offset)};
}

template <class R>
PLIANT_HD ClosestOnTriangle<R> nearer(const ClosestOnTriangle<R>& first, const ClosestOnTriangle<R>& second) {
  const auto better = second.distance_squared < first.distance_squared;
  return {select(better, second.point, first.point), select(better, second.weights, first.weights),
          select(better, second.distance_squared, first.distance_squared)};
}

/// Barycentric weights of p projected onto the triangle's plane, clamped to the triangle; exact for inner projections.
template <class R>
PLIANT_HD Vec3<R> weights_of_foot(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c) {
  const Vec3<R> normal = cross(b - a, c - a);
  const R zero = R(0);
  const R wa = max(dot(cross(c - b, p - b), normal), zero);
  const R wb = max(dot(cross(a - c, p - c), normal), zero);
  const R wc = max(dot(cross(b - a, p - a), normal), zero);
  const R sum = wa + wb + wc;
  const auto none = sum < least_divisor<R>();
  const R scale = R(1) / max(sum, least_divisor<R>());
  return {select(none, R(1), wa * scale), select(none, zero, wb * scale), select(none, zero, wc * scale)};
}

}  // namespace detail

/// The point of triangle (a, b, c) closest to p. A degenerate triangle acts as a segment or a point.
template <class R>
PLIANT_HD ClosestOnTriangle<R> closest_on_triangle(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b,
                                                   const Vec3<R>& c) {
  using detail::nearer, detail::triangle_candidate;
  const R zero = R(0), one = R(1);
  const R ab = closest_on_segment(p, a, b), bc = closest_on_segment(p, b, c), ca = closest_on_segment(p, c, a);
  const auto inside = triangle_candidate(p, a, b, c, detail::weights_of_foot(p, a, b, c));
  const auto on_ab = triangle_candidate(p, a, b, c, Vec3<R>{one - ab, ab, zero});
  const auto on_bc = triangle_candidate(p, a, b, c, Vec3<R>{zero, one - bc, bc});
  const auto on_ca = triangle_candidate(p, a, b, c, Vec3<R>{ca, zero, one - ca});
  return nearer(nearer(inside, on_ab), nearer(on_bc, on_ca));
}

/// The closest points of two segments.
template <class R>
struct ClosestOnSegments {
  R s, t;                 ///< shares in [0, 1] along the first and the second segment
  Vec3<R> first, second;  ///< closest points [m]
  R distance_squared;     ///< squared distance of the closest points [m^2]
};

namespace detail {

template <class R>
PLIANT_HD ClosestOnSegments<R> segments_candidate(const Vec3<R> (&p)[2], const Vec3<R> (&q)[2], const R& s,
                                                  const R& t) {
  const Vec3<R> along_p = s * (p[1] - p[0]), along_q = t * (q[1] - q[0]);
  return {s, t, p[0] + along_p, q[0] + along_q, length_squared((p[0] - q[0]) + (along_p - along_q))};
}

template <class R>
PLIANT_HD ClosestOnSegments<R> nearer(const ClosestOnSegments<R>& first, const ClosestOnSegments<R>& second) {
  const auto better = second.distance_squared < first.distance_squared;
  return {select(better, second.s, first.s), select(better, second.t, first.t),
          select(better, second.first, first.first), select(better, second.second, first.second),
          select(better, second.distance_squared, first.distance_squared)};
}

/// The closest points of two lines, s clamped to [0, 1] and t optimal for it: the solution if both points are inside.
template <class R>
PLIANT_HD ClosestOnSegments<R> closest_inside(const Vec3<R> (&p)[2], const Vec3<R> (&q)[2]) {
  const Vec3<R> u = p[1] - p[0], v = q[1] - q[0], w = p[0] - q[0];
  const R vv = length_squared(v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const R determinant = length_squared(cross(u, v));  // |u|^2 |v|^2 - (u . v)^2 without its cancellation
  const R s = to_unit_interval((uv * vw - vv * uw) / max(determinant, least_divisor<R>()));
  return segments_candidate(p, q, s, to_unit_interval((uv * s + vw) / max(vv, least_divisor<R>())));
}

}  // namespace detail

/// The closest points of the segments p[0] p[1] and q[0] q[1]; any closest pair if parallel. Degenerate segments are
/// valid.
template <class R>
PLIANT_HD ClosestOnSegments<R> closest_on_segments(const Vec3<R> (&p)[2], const Vec3<R> (&q)[2]) {
  using detail::nearer, detail::segments_candidate;
  const R zero = R(0), one = R(1);
  const auto inside = detail::closest_inside(p, q);
  const auto at_p0 = segments_candidate(p, q, zero, closest_on_segment(p[0], q[0], q[1]));
  const auto at_p1 = segments_candidate(p, q, one, closest_on_segment(p[1], q[0], q[1]));
  const auto at_q0 = segments_candidate(p, q, closest_on_segment(q[0], p[0], p[1]), zero);
  const auto at_q1 = segments_candidate(p, q, closest_on_segment(q[1], p[0], p[1]), one);
  return nearer(inside, nearer(nearer(at_p0, at_p1), nearer(at_q0, at_q1)));
}

/// The area of a triangle [m^2].
template <class R>
PLIANT_HD R triangle_area(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c) {
  return R(0.5f) * length(cross(b - a, c - a));
}

/// The unit normal of a triangle, on the side from which a, b, c run counter-clockwise; zero if the triangle is
/// degenerate in R. Edges are scaled first, so any size works.
template <class R>
PLIANT_HD Vec3<R> triangle_normal(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c) {
  const Vec3<R> ab = b - a, ac = c - a;
  const R size = max(max(largest(ab), largest(ac)), detail::least_divisor<R>());
  const Vec3<R> scaled_ab{ab.x / size, ab.y / size, ab.z / size}, scaled_ac{ac.x / size, ac.y / size, ac.z / size};
  return unit_or(cross(scaled_ab, scaled_ac), Vec3<R>{R(0), R(0), R(0)});
}

/// Six times the signed volume of the tetrahedron formed by the origin and a triangle [m^3]. The sum over a closed
/// surface that faces outward is six times the enclosed volume.
template <class R>
PLIANT_HD R six_volumes(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c) {
  return dot(cross(a, b), c);
}

/// The signed volume of a tetrahedron: positive if d is on the side of the normal of (a, b, c) [m^3].
template <class R>
PLIANT_HD R tetrahedron_volume(const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c, const Vec3<R>& d) {
  return six_volumes(b - a, c - a, d - a) / R(6);
}

}  // namespace pliant
