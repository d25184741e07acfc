// The first time at which moving primitives come within a thickness:
// vertex-triangle and edge-edge, with linear motion of all corners.
//
// Conservative advancement (Mirtich 1996), with a separating plane as the bound instead of a speed; no
// polynomial is solved. At a time t of separation, the direction between the closest points gives a
// separating plane. Along it each pair of corners closes its gap linearly, so no contact occurs before
// the first pair closes it. Advance to that time, take a new direction, repeat. Sliding flat primitives
// need a single step. The gap is measured along the current direction, never from the closest points: a
// poor direction costs steps, or reports a contact that rounding makes, but never misses one.
//
//        A   o-----o                   n.A >= n.b + gap for all of A,
//              a                       n.B <= n.b           for all of B
//        - - - ^ n - - - - plane
//              b
//        B   o-----o
#pragma once

#include "geometry/triangle.h"

namespace pliant {

/// The first time at which two moving primitives are within a thickness.
template <class R>
struct Impact {
  bool hit = false;
  R time{};           ///< share of the motion, 0..1: at or before the true time; 0 if they start within the thickness
  Vec3<R> normal{};   ///< unit normal, from the second primitive to the first at `time`; zero if their points coincide
  R gap{};            ///< distance along the normal at `time` [m]: about the thickness, or less if they start within it
  bool front = true;  ///< vertex-triangle: true if the vertex is on the side of the triangle's normal
};

namespace detail {

/// Four corners: the first `A` form one primitive, the rest the other. Vertex-triangle A = 1, edge-edge A = 2.
template <class R>
struct Corners {
  Vec3<R> at[4];
};

template <class R>
struct Slab {
  Vec3<R> normal;  ///< unit normal of the plane, or zero
  R gap;           ///< least distance of the two primitives along the normal
};

template <int A, class R>
PLIANT_HD Slab<R> slab_along(const Vec3<R>& direction, const Corners<R>& x) {
  const R size = largest(direction);
  if (!(size > least_divisor<R>())) return {{}, R(-1e30f)};
  const Vec3<R> scaled{direction.x / size, direction.y / size, direction.z / size};
  const Vec3<R> normal = scaled * (R(1) / length(scaled));
  R low_a = dot(normal, x.at[0]), high_a = low_a, low_b = dot(normal, x.at[3]), high_b = low_b;
  for (int i = 1; i < 3; ++i) {
    const R s = dot(normal, x.at[i]);
    if (i < A) {
      low_a = min(low_a, s);
      high_a = max(high_a, s);
    } else {
      low_b = min(low_b, s);
      high_b = max(high_b, s);
    }
  }
  const bool turned = low_b - high_a > low_a - high_b;
  return {turned ? -normal : normal, turned ? low_b - high_a : low_a - high_b};
}

template <class R>
PLIANT_HD Slab<R> wider(const Slab<R>& first, const Slab<R>& second) {
  return second.gap > first.gap ? second : first;
}

template <class R>
PLIANT_HD Vec3<R> without_component_along(const Vec3<R>& v, const Vec3<R>& edge) {
  return v - edge * (dot(v, edge) / max(length_squared(edge), least_divisor<R>()));
}

/// The vector from the closest point of the second primitive to the closest point of the first.
template <int A, class R>
PLIANT_HD Vec3<R> closest_direction(const Corners<R>& x) {
  if constexpr (A == 1) {
    return x.at[0] - closest_on_triangle(x.at[0], x.at[1], x.at[2], x.at[3]).point;
  } else {
    const auto closest = closest_on_segments<R>({x.at[0], x.at[1]}, {x.at[2], x.at[3]});
    return closest.first - closest.second;
  }
}

/// The widest separating slab found. If the primitives nearly touch, rounding rotates the direction between the closest
/// points by more than the gap allows. The normals of the triangle, of both edges, or of one edge then serve.
template <int A, class R>
PLIANT_HD Slab<R> widest_slab(const Corners<R>& x) {
  const Vec3<R> direction = closest_direction<A>(x);
  Slab<R> best = slab_along<A>(direction, x);
  if (best.gap > R(0.9f) * length(direction)) return best;
  const Vec3<R> u = A == 1 ? x.at[2] - x.at[1] : x.at[1] - x.at[0];
  const Vec3<R> v = x.at[3] - x.at[2];
  best = wider(best, slab_along<A>(cross(u, v), x));
  best = wider(best, slab_along<A>(without_component_along(direction, u), x));
  best = wider(best, slab_along<A>(without_component_along(direction, v), x));
  if (A == 1) best = wider(best, slab_along<A>(without_component_along(direction, x.at[1] - x.at[3]), x));
  return best;
}

template <class R>
PLIANT_HD Corners<R> corners_at(const Corners<R>& start, const Corners<R>& motion, const R& t) {
  Corners<R> x;
  for (int i = 0; i < 4; ++i) x.at[i] = start.at[i] + motion.at[i] * t;
  return x;
}

/// The least t > 0 with a + b t + c t^2 = 0, for a > 0; 2 if there is none before. The formula avoids cancellation: its
/// result is exact for coefficients changed by a few roundings.
template <class R>
PLIANT_HD R first_root(const R& a, const R& b, const R& c) {
  const R discriminant = b * b - R(4) * a * c;
  if (discriminant < R(0)) return R(2);
  const R root = sqrt(discriminant);
  if (b < R(0)) return min(R(2), R(2) * a / (root - b));
  return c < R(0) ? min(R(2), (b + root) / (R(-2) * c)) : R(2);
}

/// The share of the motion during which all pairs of corners stay farther apart than `least` along a rotating normal; 2
/// if that exceeds it. The normal starts as a unit vector and changes by `turn` per unit of time, so each pair's
/// distance is quadratic. Valid while the normal is not longer than 1.
template <int A, class R>
PLIANT_HD R free_share(const Corners<R>& x, const Corners<R>& motion, const Vec3<R>& normal, const Vec3<R>& turn,
                       const R& least) {
  R share = R(2);
  for (int i = 0; i < A; ++i)
    for (int j = A; j < 4; ++j) {
      const Vec3<R> apart = x.at[i] - x.at[j], opening = motion.at[i] - motion.at[j];
      share = min(share,
                  first_root(dot(normal, apart) - least, dot(turn, apart) + dot(normal, opening), dot(turn, opening)));
    }
  return share;
}

/// The largest coordinate range, which scales rounding errors.
template <class R>
PLIANT_HD R extent(const Corners<R>& start, const Corners<R>& motion) {
  R size = R(0);
  for (int i = 0; i < 4; ++i) size = max(size, largest(start.at[i]) + largest(motion.at[i]));
  return size;
}

/// At least half a unit in the last place of 1. Other number types overload it.
PLIANT_HD float unit_roundoff(float) { return 6e-8f; }
PLIANT_HD double unit_roundoff(double) { return 1.2e-16; }

constexpr int most_advances = 400;    // largest number of advances; few except in constructed cases
constexpr int plain_advances = 4;     // number of advances before the plane may rotate
constexpr float longest_attempt = 4;  // limit of an attempted advance, as a multiple of the last one

/// For nearly parallel edges that rotate, a fixed plane is valid only briefly: the far ends run into it. A plane that
/// rotates towards its later orientation stays valid longer, by the root of the gap instead of the gap. Its normal
/// interpolates two unit vectors, so it is never longer than 1.
template <int A, class R>
PLIANT_HD R turning_share(const Corners<R>& start, const Corners<R>& motion, const Corners<R>& x, const Vec3<R>& normal,
                          const R& t, const R& attempt, const R& least) {
  const Vec3<R> then = widest_slab<A>(corners_at(start, motion, t + attempt)).normal;
  const Vec3<R> turn = (then - normal) * (R(1) / attempt);
  return length_squared(then - normal) < R(1) ? min(attempt, free_share<A>(x, motion, normal, turn, least)) : R(0);
}

/// True if one primitive's range of a coordinate is above the other's by more than `least`; exact under rounding for 0.
template <int A, class R, class Coordinate>
PLIANT_HD bool apart_along(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& least,
                           const Coordinate& coordinate) {
  R low[2], high[2];
  for (int i = 0; i < 4; ++i) {
    const int side = i < A ? 0 : 1;
    const R first = coordinate(from[i]), second = coordinate(to[i]);
    const bool starts = i == 0 || i == A;
    low[side] = starts ? min(first, second) : min(low[side], min(first, second));
    high[side] = starts ? max(first, second) : max(high[side], max(first, second));
  }
  return low[0] - high[1] > least || low[1] - high[0] > least;
}

/// True if the boxes of the two motions are farther apart than the thickness along an axis.
template <int A, class R>
PLIANT_HD bool boxes_apart(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  const R least = thickness + R(4) * unit_roundoff(R(0)) * thickness;
  return apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.x; }) ||
         apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.y; }) ||
         apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.z; });
}

/// The corners' paths relative to the start of the last corner: far from the
/// origin, differences are small and exact, unlike products of coordinates.
template <class R>
struct Paths {
  Corners<R> start, motion;
};

template <class R>
PLIANT_HD Paths<R> relative_paths(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4]) {
  Paths<R> paths;
  for (int i = 0; i < 4; ++i) {
    paths.start.at[i] = from[i] - from[3];
    paths.motion.at[i] = (to[i] - from[3]) - paths.start.at[i];
  }
  return paths;
}

/// The test from the time `since` on; separation is known until then.
template <int A, class R>
PLIANT_HD Impact<R> first_impact(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness,
                                 const R& since = R(0)) {
  if (boxes_apart<A>(from, to, thickness)) return {};
  const auto [start, motion] = relative_paths(from, to);
  const R rounding = R(32) * unit_roundoff(R(0)) * (extent(start, motion) + thickness);
  const R least = thickness + rounding;
  R t = since, share = R(0);
  Slab<R> slab{};
  Vec3<R> normal{};
  for (int step = 0; step < most_advances; ++step) {
    const Corners<R> x = corners_at(start, motion, t);
    slab = widest_slab<A>(x);
    if (slab.gap > R(0)) normal = slab.normal;
    if (!(slab.gap > thickness + R(2) * rounding)) break;
    const R attempt = min(R(1) - t, R(longest_attempt) * share);
    share = free_share<A>(x, motion, slab.normal, Vec3<R>{}, least);
    if (step >= plain_advances && share < attempt)
      share = max(share, turning_share<A>(start, motion, x, slab.normal, t, attempt, least));
    if (!(t + share < R(1))) return {};
    t = t + share;
  }
  return {true, t, normal, slab.gap, true};
}

template <class R>
PLIANT_HD bool faces_front(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const Impact<R>& impact) {
  const Vec3<R> ab = (from[2] - from[1]) + ((to[2] - to[1]) - (from[2] - from[1])) * impact.time;
  const Vec3<R> ac = (from[3] - from[1]) + ((to[3] - to[1]) - (from[3] - from[1])) * impact.time;
  return !(dot(cross(ab, ac), impact.normal) < R(0));
}

}  // namespace detail

/// The first time at which a vertex, (0) of the arrays, comes within `thickness` (>= 0) [m] of a triangle, (1, 2, 3),
/// under linear motion from `from` to `to`. Conservative: never misses a contact or reports it late. It may report
/// pairs that pass within about 100 roundings of the extent, or that rotate by over a radian a thousandth of their size
/// apart. R is float or another rounding number type; coordinates finite and below 1e15.
template <class R>
PLIANT_HD Impact<R> vertex_triangle_impact(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  Impact<R> impact = detail::first_impact<1>(from, to, thickness);
  impact.front = detail::faces_front(from, to, impact);
  return impact;
}

/// The first time at which the edges (0, 1) and (2, 3) of the arrays come within `thickness`, as
/// vertex_triangle_impact.
template <class R>
PLIANT_HD Impact<R> edge_edge_impact(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  return detail::first_impact<2>(from, to, thickness);
}

/// The certified test in double. Contacts that double precision cannot prove are repeated in double-double precision,
/// so pairs farther apart than 1e-29 of the extent are no contact. Host only.
Impact<double> vertex_triangle_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

/// The certified test for the edges (0, 1) and (2, 3) of the arrays.
Impact<double> edge_edge_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

}  // namespace pliant
