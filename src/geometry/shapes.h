// The primitive shapes of colliders: signed distance, and the first hit of a moving point.
//
// Every shape is convex, so one short algorithm handles continuous collision. Along a
// straight path the signed distance to a convex set is a convex function of time. Newton's
// method from outside thus approaches the first contact from before it and never steps
// over it, at any speed and thickness. A new convex shape needs only a signed distance.
//
// A shape is a kind and three numbers, not a std::variant, because the same code runs on devices. Coordinates are in
// the shape's local frame [m], as scene.h defines it, and up to 1e18 in float.
#pragma once

#include "math/quat.h"
#include "math/vector.h"

namespace pliant {

enum class ShapeKind : int { plane, sphere, capsule, box };

/// A solid in its local frame. Plane (the half-space y <= 0): none; sphere: a = radius; capsule along y: a = radius, b
/// = half axis length; box: a, b, c = half extents along x, y, z. All >= 0 [m].
struct LocalShape {
  ShapeKind kind = ShapeKind::plane;
  float a = 0, b = 0, c = 0;
};

/// The signed distance of a point to a surface, and the outward normal.
template <class R>
struct SurfaceDistance {
  R distance;      ///< signed distance, negative inside [m]
  Vec3<R> normal;  ///< gradient of the distance: unit length, defined everywhere
};

/// Distance to a sphere: |p| - radius. At the centre the normal is +y.
template <class R>
PLIANT_HD SurfaceDistance<R> sphere_distance(const R& radius, const Vec3<R>& p) {
  return {length(p) - radius, unit_or(p, Vec3<R>{R(0), R(1), R(0)})};
}

/// Distance to a capsule: from the nearest point of its axis, minus the radius. On the axis the normal is +x.
template <class R>
PLIANT_HD SurfaceDistance<R> capsule_distance(const R& radius, const R& half_length, const Vec3<R>& p) {
  const Vec3<R> q{p.x, p.y - clamp(p.y, -half_length, half_length), p.z};
  return {length(q) - radius, unit_or(q, Vec3<R>{R(1), R(0), R(0)})};
}

/// Distance to a box. Outside: to its nearest point, so edges and corners count as round. Inside: to the nearest face,
/// of equally near ones that of the earlier axis.
template <class R>
PLIANT_HD SurfaceDistance<R> box_distance(const Vec3<R>& half_extents, const Vec3<R>& p) {
  const R zero = R(0), one = R(1);
  const Vec3<R> q = abs(p) - half_extents;
  const Vec3<R> sign{select(p.x < zero, -one, one), select(p.y < zero, -one, one), select(p.z < zero, -one, one)};
  const R deepest = max(max(q.x, q.y), q.z);
  const auto at_x = q.x >= deepest, at_y = q.y >= deepest;
  const Vec3<R> face{select(at_x, sign.x, zero), select(at_x, zero, select(at_y, sign.y, zero)),
                     select(at_x, zero, select(at_y, zero, sign.z))};
  const Vec3<R> over = max(q, Vec3<R>{zero, zero, zero});
  const R squared = length_squared(over), least = R(1.17549435e-38f);
  const R beyond = sqrt(max(squared, least));
  const auto outside = squared > least;
  const Vec3<R> away{sign.x * over.x / beyond, sign.y * over.y / beyond, sign.z * over.z / beyond};
  return {select(outside, beyond, deepest), select(outside, away, face)};
}

/// The signed distance from a point to a shape, and the outward normal there.
template <class R>
PLIANT_HD SurfaceDistance<R> signed_distance(const LocalShape& shape, const Vec3<R>& point) {
  switch (shape.kind) {
    case ShapeKind::sphere:
      return sphere_distance(R(shape.a), point);
    case ShapeKind::capsule:
      return capsule_distance(R(shape.a), R(shape.b), point);
    case ShapeKind::box:
      return box_distance(Vec3<R>{R(shape.a), R(shape.b), R(shape.c)}, point);
    case ShapeKind::plane:
      break;
  }
  return {point.y, Vec3<R>{R(0), R(1), R(0)}};
}

/// The first point of a path within `margin` of a shape.
template <class R>
struct FirstHit {
  bool hit = false;
  R t{};             ///< share of the path, 0..1; 0 if it starts inside
  Vec3<R> point{};   ///< position at t, more exact than a + t (b - a) on long paths [m]
  Vec3<R> normal{};  ///< outward, unit; towards the side that the point came from, unless it starts inside
  R distance{};      ///< signed distance of `point`: margin within rounding, or less if the path starts inside [m]
};

/// The first t in [0, 1] at which a + t (b - a) is within `margin` (>= 0) of the shape, to a few roundings of the
/// coordinates: a path that misses by less counts as touching. R is float or double.
///
/// For a moving shape, pass a in its frame at the start and b in its frame at the end of the step. Non-finite
/// coordinates give no hit; no hit is guaranteed beyond 1e18.
template <class R>
PLIANT_HD FirstHit<R> first_hit(const LocalShape& shape, const Vec3<R>& a, const Vec3<R>& b, const R& margin) {
  const R rounding =
      sizeof(R) == sizeof(float) ? R(2.4e-7f) : R(4.5e-16);  // two units in the last place of the number 1
  const Vec3<R> path = b - a;
  const R path_size = abs(path.x) + abs(path.y) + abs(path.z);
  if (!(path_size + abs(a.x) + abs(a.y) + abs(a.z) < R(1e38f))) return {};
  FirstHit<R> at{false, R(0), a, {}, R(0)};
  R travelled = R(0);  // how far the last step advanced
  // Convergence is quadratic if the path crosses the surface. If it
  // grazes, the gap shrinks fourfold per step: 64 steps suffice from 1e38.
  for (int step = 0; step < 96; ++step) {
    const SurfaceDistance<R> surface = signed_distance(shape, at.point);
    const R gap = surface.distance - margin, slope = dot(surface.normal, path);
    const R exact = rounding * (abs(at.point.x) + abs(at.point.y) + abs(at.point.z));
    const bool leaving = !(slope < R(0));
    at.distance = surface.distance;
    // Rounding may carry the point past the middle of a thin shape; the normal of the previous side still holds.
    if (step == 0 || !leaving) at.normal = surface.normal;
    at.hit = gap <= exact || (leaving && gap <= rounding * travelled);
    if (at.hit) return at;
    if (leaving || !(at.t < R(1))) return {};  // a convex shape: if the point recedes, it never comes back
    const R advance = -gap / slope;
    const bool last = !(at.t + advance < R(1));
    travelled = last ? (R(1) - at.t) * path_size : advance * path_size;
    // Incremental advances round relative to the current position, not to the whole path.
    at.point = last ? b : at.point + advance * path;
    at.t = last ? R(1) : at.t + advance;
  }
  return {};
}

/// A bounding sphere of a shape; the radius is infinite for a plane.
template <class R>
struct BoundingSphere {
  Vec3<R> centre;
  R radius;
};

/// An axis-aligned bounding box of a shape; infinite on all sides for a plane.
template <class R>
struct BoundingBox {
  Vec3<R> low, high;
};

/// The smallest box around two boxes.
template <class R>
PLIANT_HD BoundingBox<R> merge(const BoundingBox<R>& a, const BoundingBox<R>& b) {
  return {min(a.low, b.low), max(a.high, b.high)};
}

/// Half extents of the shape's local bounding box; infinite for a plane.
template <class R>
PLIANT_HD Vec3<R> half_sides(const LocalShape& shape) {
  switch (shape.kind) {
    case ShapeKind::sphere:
      return {R(shape.a), R(shape.a), R(shape.a)};
    case ShapeKind::capsule:
      return {R(shape.a), R(shape.a) + R(shape.b), R(shape.a)};
    case ShapeKind::box:
      return {R(shape.a), R(shape.b), R(shape.c)};
    case ShapeKind::plane:
      break;
  }
  return {R(__builtin_inff()), R(__builtin_inff()), R(__builtin_inff())};
}

/// The bounding sphere, centred at the pose's position, of the shape grown by `margin`; rounded outward.
template <class R>
PLIANT_HD BoundingSphere<R> bounding_sphere(const LocalShape& shape, const Pose<R>& pose, const R& margin) {
  const R rounding = sizeof(R) == sizeof(float) ? R(1e-6f) : R(2e-15);
  const Vec3<R> half = half_sides<R>(shape);
  const R reach = shape.kind == ShapeKind::box ? length(half) : max(half.x, half.y);
  return {pose.position, (reach + margin) * (R(1) + rounding) + largest(pose.position) * rounding};
}

/// The axis-aligned bounding box of the posed shape grown by `margin`, rounded outward; tight for a box.
template <class R>
PLIANT_HD BoundingBox<R> bounding_box(const LocalShape& shape, const Pose<R>& pose, const R& margin) {
  const R rounding = sizeof(R) == sizeof(float) ? R(1e-6f) : R(2e-15);
  const R radius = shape.kind == ShapeKind::box ? R(0) : half_sides<R>(shape).x;
  const Vec3<R> core = shape.kind == ShapeKind::box       ? half_sides<R>(shape)
                       : shape.kind == ShapeKind::capsule ? Vec3<R>{R(0), R(shape.b), R(0)}
                                                          : Vec3<R>{R(0), R(0), R(0)};
  const Vec3<R> x = abs(rotate(pose.rotation, Vec3<R>{core.x, R(0), R(0)}));
  const Vec3<R> y = abs(rotate(pose.rotation, Vec3<R>{R(0), core.y, R(0)}));
  const Vec3<R> z = abs(rotate(pose.rotation, Vec3<R>{R(0), R(0), core.z}));
  const R grown = (radius + margin) * (R(1) + rounding) + (largest(pose.position) + largest(core)) * rounding;
  const Vec3<R> half = x + y + z + Vec3<R>{grown, grown, grown};
  return {pose.position - half, pose.position + half};
}

}  // namespace pliant
