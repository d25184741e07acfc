// Contacts of particles with one primitive collider: what the scalar search and its SIMD kernel
// (solver/contact_lanes.cpp) share.
#pragma once

#include <cstdint>

#include "constraints/contact.h"
#include "geometry/shapes.h"
#include "model/substep.h"

namespace pliant {

/// Limit of the depenetration speed, so that deep overlaps neither explode nor tear the object's own constraints
/// [m/s].
inline constexpr float largest_separation_speed = 2;

/// A plane that a particle must stay above, in the collider's frame.
template <class R>
struct SurfacePlane {
  Vec3<R> normal;  ///< unit normal
  Vec3<R> point;   ///< a point of the surface
  R offset;        ///< offset of the plane from the origin along the normal [m]
};

/// A path longer than this share of the thickness is searched for its first hit, unless stays_beyond excludes one.
inline constexpr float share_of_short_path = 0.25f;
/// The distance from the surface at which a path hits it, over the thickness.
inline constexpr float share_of_first_hit = 0.5f;

/// True if a path longer than 1e-18 m stays farther than `margin` from a convex shape, with room for all roundings, so
/// that first_hit finds nothing: the distance nowhere falls below that of the tangent plane at the path's end.
template <class R>
PLIANT_HD auto stays_beyond(const R& margin, const SurfaceDistance<R>& end, const Vec3<R>& to, const Vec3<R>& path) {
  const R rounded = R(1e-5f) * (largest(to) + largest(path) + margin);
  return end.distance - max(dot(end.normal, path), R(0.f)) > margin + rounded;
}

/// The distance to maintain for a path that starts at `start`: `thickness`, or less to limit the depenetration speed.
template <class R>
PLIANT_HD R height_after(const R& start, const R& thickness, float h) {
  return min(thickness, start + R(largest_separation_speed * h));
}

/// The plane at the surface point closest to a path's end `to`, `height` above the surface.
template <class R>
PLIANT_HD SurfacePlane<R> plane_at_end(const SurfaceDistance<R>& end, const Vec3<R>& to, const R& height) {
  return {end.normal, to - end.normal * end.distance, dot(end.normal, to) - end.distance + height};
}

/// The fields of a particle's contact that its geometry and velocity determine.
template <class R>
struct PointContact {
  Vec3<R> normal;
  R gap;
  Vec3<R> surface_motion;
  R approach;
};

/// The contact of a particle at `position` with a plane of a collider, whose pose changes in the substep if it `moves`.
template <class R>
PLIANT_HD PointContact<R> contact_at_plane(const SurfacePlane<R>& plane, const Pose<R>& before, const Pose<R>& after,
                                           bool moves, const Vec3<R>& position, const Vec3<R>& velocity,
                                           float inverse_h) {
  PointContact<R> out;
  out.normal = rotate(after.rotation, plane.normal);
  // The plane in world coordinates: the same point, and the same height of the plane above it.
  const Vec3<R> point = to_world(after, plane.point);
  const R above = plane.offset - dot(plane.normal, plane.point), zero = R(0.f);
  out.gap = dot(out.normal, position - point) - above;
  out.surface_motion = Vec3<R>{zero, zero, zero};
  if (moves) out.surface_motion = point - to_world(before, plane.point);
  out.approach = dot(out.normal, velocity - out.surface_motion * R(inverse_h));
  return out;
}

/// The particles of an object, a primitive collider, and what all their contacts have in common.
struct PointContactQuery {
  AdvanceArguments particles;  ///< the particles, with their predicted displacements
  LocalShape shape;
  Pose<float> before, after;  ///< poses of the collider at the substep's start and end
  bool moves;                 ///< true if the poses differ
  int collider;               ///< index of the collider
  float thickness;            ///< thickness of particles and collider together [m]
  Vec3f gravity;              ///< to add to a velocity for that before this substep's gravity [m/s]
  float static_friction, kinetic_friction, restitution;
};

/// The results for sixteen particles, one per lane.
struct PointContactLanes {
  unsigned found = 0;    ///< bit l: particle l has a contact, which is complete
  unsigned unclear = 0;  ///< bit l: particle l is fast, so its path must be searched for the first hit
};

/// Writes sixteen contacts, of particle l into contact l. Contacts of particles that are not `found` are meaningless.
using MakePointContacts = PointContactLanes (*)(const PointContactQuery& query, const std::int32_t* particles,
                                                Contact* contacts);

}  // namespace pliant
