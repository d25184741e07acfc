// When moving primitives first come within a thickness of one another: vertex against triangle, edge against edge, every
// corner moving along a straight line.
//
// No polynomial is solved. At a time t where the two are apart, the direction between their closest points gives a plane
// between them; along that direction each pair of corners closes its gap linearly, so the time until the first pair closes
// it is certainly free of contact. Advance to it, take a new direction, repeat: conservative advancement (Mirtich 1996) with a
// plane for a bound instead of a speed, which makes two flat things that slide past one another a single step. The gap is
// always measured along the direction in hand, never taken from the closest points: a poor direction costs steps, or in
// the end a contact that is none by a rounding, but it cannot miss one.
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
  R time{};           ///< share of the motion, 0..1: never after the true time; 0 where they begin within the thickness
  Vec3<R> normal{};   ///< unit, from the second primitive to the first then; zero where they begin with a point in common
  R gap{};            ///< along the normal then [m]; about the thickness, or less where they begin within it
  bool front = true;  ///< vertex and triangle: whether the vertex is on the side that the triangle's normal faces
};

namespace detail {

/// Four corners, the first `A` of which are one primitive and the others the second: vertex-triangle A = 1, edges A = 2.
template <class R>
struct Corners {
  Vec3<R> at[4];
};

template <class R>
struct Slab {
  Vec3<R> normal;  ///< unit, or zero
  R gap;           ///< least distance of the two primitives along it
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

/// From the closest point of the second primitive to that of the first.
template <int A, class R>
PLIANT_HD Vec3<R> closest_direction(const Corners<R>& x) {
  if constexpr (A == 1) {
    return x.at[0] - closest_on_triangle(x.at[0], x.at[1], x.at[2], x.at[3]).point;
  } else {
    const auto closest = closest_on_segments<R>({x.at[0], x.at[1]}, {x.at[2], x.at[3]});
    return closest.first - closest.second;
  }
}

/// The widest slab found between the two. Where they nearly touch, rounding turns the direction between the closest points by
/// more than the gap allows; then what it must be perpendicular to decides: the triangle or both edges, or one edge.
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

/// The least t > 0 at which a + b t + c t^2, a > 0, is zero; 2 where there is none before. The formula without cancellation:
/// what it gives is exact for coefficients that differ by a few roundings.
template <class R>
PLIANT_HD R first_root(const R& a, const R& b, const R& c) {
  const R discriminant = b * b - R(4) * a * c;
  if (discriminant < R(0)) return R(2);
  const R root = sqrt(discriminant);
  if (b < R(0)) return min(R(2), R(2) * a / (root - b));
  return c < R(0) ? min(R(2), (b + root) / (R(-2) * c)) : R(2);
}

/// The share of the whole motion for which all pairs of corners stay further apart than `least` along a normal that begins as a
/// unit vector and turns by `turn` a unit of time, so that each pair's distance is a quadratic; 2 where it is longer than all.
/// Holds for as long as the turning normal is no longer than 1.
template <int A, class R>
PLIANT_HD R free_share(const Corners<R>& x, const Corners<R>& motion, const Vec3<R>& normal, const Vec3<R>& turn,
                       const R& least) {
  R share = R(2);
  for (int i = 0; i < A; ++i)
    for (int j = A; j < 4; ++j) {
      const Vec3<R> apart = x.at[i] - x.at[j], opening = motion.at[i] - motion.at[j];
      share =
          min(share, first_root(dot(normal, apart) - least, dot(turn, apart) + dot(normal, opening), dot(turn, opening)));
    }
  return share;
}

/// Size of everything there is, the scale of rounding.
template <class R>
PLIANT_HD R extent(const Corners<R>& start, const Corners<R>& motion) {
  R size = R(0);
  for (int i = 0; i < 4; ++i) size = max(size, largest(start.at[i]) + largest(motion.at[i]));
  return size;
}

/// At least half a unit in the last place of 1. Other types of number overload it.
PLIANT_HD float unit_roundoff(float) { return 6e-8f; }
PLIANT_HD double unit_roundoff(double) { return 1.2e-16; }

constexpr int most_advances = 400;    // a handful in all but constructed cases
constexpr int plain_advances = 4;     // before the plane is let turn
constexpr float longest_attempt = 4;  // times as far as the last advance

/// Where edges lie close along one another and turn, a fixed plane serves for moments only: the far ends run into it. One that
/// turns towards where it will be needed serves for longer, by a root of the gap instead of the gap itself. On its way from one unit
/// vector to another it is never longer than 1.
template <int A, class R>
PLIANT_HD R turning_share(const Corners<R>& start, const Corners<R>& motion, const Corners<R>& x, const Vec3<R>& normal,
                          const R& t, const R& attempt, const R& least) {
  const Vec3<R> then = widest_slab<A>(corners_at(start, motion, t + attempt)).normal;
  const Vec3<R> turn = (then - normal) * (R(1) / attempt);
  return length_squared(then - normal) < R(1) ? min(attempt, free_share<A>(x, motion, normal, turn, least)) : R(0);
}

/// Whether an interval of two numbers lies above another by more than `least`, a comparison that no rounding changes for 0.
template <int A, class R, class Coordinate>
PLIANT_HD bool apart_along(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& least, const Coordinate& coordinate) {
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

/// Whether the boxes of the two motions are further apart than the thickness along an axis.
template <int A, class R>
PLIANT_HD bool boxes_apart(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  const R least = thickness + R(4) * unit_roundoff(R(0)) * thickness;
  return apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.x; }) ||
         apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.y; }) ||
         apart_along<A>(from, to, least, [](const Vec3<R>& p) { return p.z; });
}

/// The corners' motions relative to where the last one begins: far from the origin differences are small and exact,
/// products of coordinates are neither.
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

/// `since`: until when they are known to be apart.
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

/// When a vertex, (0) of the arrays, first comes within `thickness` (>= 0) [m] of a triangle, (1, 2, 3), as all move straight
/// from `from` to `to`. Never misses a contact, nor finds it too late; finds one where the two pass each other at up to some
/// 100 roundings of the motion's extent beyond the thickness, or turn by far more than a radian a thousandth of their size apart.
/// R is float, or another type of number that rounds; coordinates finite and below 1e15.
template <class R>
PLIANT_HD Impact<R> vertex_triangle_impact(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  Impact<R> impact = detail::first_impact<1>(from, to, thickness);
  impact.front = detail::faces_front(from, to, impact);
  return impact;
}

/// The same for the edges (0, 1) and (2, 3).
template <class R>
PLIANT_HD Impact<R> edge_edge_impact(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4], const R& thickness) {
  return detail::first_impact<2>(from, to, thickness);
}

/// The same in double, and decided: what double precision takes for a contact and can't prove to be one is looked at
/// again in twice the precision, so that what passes by at more than 1e-29 of the extent is no contact. For hosts.
Impact<double> vertex_triangle_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

/// The same for the edges (0, 1) and (2, 3).
Impact<double> edge_edge_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

}  // namespace pliant
