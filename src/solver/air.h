// Aerodynamic forces, written once: R is float for one triangle, Wide for sixteen (math/wide.h). For one they are also
// functors for launch (parallel/launch.h): per triangle, then gathered per particle.
#pragma once

#include <cstddef>

#include "math/vector.h"
#include "solver/air_kernels.h"

namespace pliant {

/// A corner of a triangle.
template <class R>
struct AirCorner {
  Vec3<R> position, velocity;
  R inverse_mass;
};

/// The aerodynamic force on a triangle [N], with u the relative
/// velocity of the air, n the normal facing the stream, A the area:
///   drag  rho/2 A c_drag (u . n) u,      lift  rho/2 A c_lift (u . n) |u| (n - u (u . n)/|u|^2),
/// as for a flat plate: zero for a plate edge-on to the stream. `response` is 2 h
/// times the mean inverse mass of the corners. The force is divided by 1 + response
/// |f| / |u|, because drag can at most stop the relative motion in a step.
template <class R>
PLIANT_HD Vec3<R> air_force(const AirCorner<R> (&corner)[3], const Vec3<R>& u, const AirArguments& a,
                            const R& response) {
  const R zero(0.f), one(1.f);
  const Vec3<R> doubled = cross(corner[1].position - corner[0].position, corner[2].position - corner[0].position);
  const R doubled_area = length(doubled), speed = length(u);
  Vec3<R> n = doubled * (one / doubled_area);
  n = select(dot(u, n) < zero, -n, n);
  const R through = dot(u, n);
  const R scale = R(0.25f * a.air_density) * doubled_area * through;
  const Vec3<R> force = u * (scale * R(a.drag)) + (n - u * (through / (speed * speed))) * (scale * R(a.lift) * speed);
  const Vec3<R> limited = force * (one / (one + response * length(force) / speed));
  const Vec3<R> none{zero, zero, zero};
  return select(doubled_area > zero, select(speed > zero, limited, none), none);
}

/// The force on a triangle with these corners [N].
template <class R>
PLIANT_HD Vec3<R> air_force(const AirCorner<R> (&corner)[3], const AirArguments& a) {
  const R zero(0.f), third(1.f / 3);
  const Vec3<R> gravity{R(a.gravity.x), R(a.gravity.y), R(a.gravity.z)}, air{R(a.air.x), R(a.air.y), R(a.air.z)};
  const Vec3<R> none{zero, zero, zero};
  Vec3<R> velocity = none;
  for (const AirCorner<R>& one : corner) velocity += one.velocity + select(one.inverse_mass > zero, gravity, none);
  const R inverse_mass = (corner[0].inverse_mass + corner[1].inverse_mass + corner[2].inverse_mass) * third;
  return air_force(corner, air - velocity * third, a, R(2 * a.h) * inverse_mass);
}

/// Computes the force on each triangle of an object.
struct AirOnTriangle {
  AirArguments a;

  PLIANT_HD void operator()(int t) const {
    const int* vertex = a.triangles + static_cast<std::ptrdiff_t>(3) * t;
    AirCorner<float> corner[3];
    for (int i = 0; i < 3; ++i) {
      const Record &p = a.positions[vertex[i]], &v = a.velocities[vertex[i]];
      corner[i] = {{p.x, p.y, p.z}, {v.x, v.y, v.z}, p.w};
    }
    const Vec3f force = air_force(corner, a);
    a.forces[t] = {force.x, force.y, force.z, 0};
  }
};

/// Adds the forces on a particle's triangles to its velocity.
struct AirOnParticle {
  AirArguments a;

  PLIANT_HD void operator()(int i) const {
    Vec3f sum{};
    for (int c = a.corner_begin[i]; c < a.corner_begin[i + 1]; ++c) {
      const Record& force = a.forces[a.corners[c] >> 2];
      sum += Vec3f{force.x, force.y, force.z};
    }
    const Vec3f change = sum * (a.h * a.positions[i].w * (1.f / 3));
    Record& v = a.velocities[i];
    v = {v.x + change.x, v.y + change.y, v.z + change.z, 0};
  }
};

/// The force of the air on a cylinder of this length and radius along a unit vector [N], with u the relative velocity
/// of the air and v its part across: rho/2 c_drag 2 r l |v| v, so nothing along the cylinder (Taylor 1952, without skin
/// friction). `response` is 2 h times the inverse mass, as above.
PLIANT_HD Vec3f air_force_on_cylinder(const Vec3f& u, const Vec3f& axis, float length_of_it, float radius,
                                      float air_density, float drag, float response) {
  const Vec3f across = u - axis * dot(u, axis);
  const float scale = air_density * drag * radius * length_of_it * length(across);
  return across * (scale / (1 + response * scale));
}

}  // namespace pliant
