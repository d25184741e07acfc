// Aerodynamic forces as functors for launch (parallel/launch.h): per triangle, then gathered per particle.
#pragma once

#include "math/vector.h"
#include "pliant/state.h"

namespace pliant {

/// The aerodynamic force on a triangle [N], with u the relative
/// velocity of the air, n the normal facing the stream, A the area:
///   drag  rho/2 A c_drag (u . n) u,      lift  rho/2 A c_lift (u . n) |u| (n - u (u . n)/|u|^2),
/// as for a flat plate: zero for a plate edge-on to the stream. `response` is 2 h
/// times the mean inverse mass of the corners. The force is divided by 1 + response
/// |f| / |u|, because drag can at most stop the relative motion in a step.
PLIANT_HD Vec3f air_force(const Vec3f (&x)[3], const Vec3f& u, float air_density, float drag, float lift,
                          float response) {
  const Vec3f doubled = cross(x[1] - x[0], x[2] - x[0]);
  const float doubled_area = length(doubled), speed = length(u);
  if (!(doubled_area > 0) || !(speed > 0)) return {};
  Vec3f n = doubled * (1 / doubled_area);
  if (dot(u, n) < 0) n = -n;
  const float through = dot(u, n);
  const float scale = 0.25f * air_density * doubled_area * through;
  const Vec3f force = u * (scale * drag) + (n - u * (through / (speed * speed))) * (scale * lift * speed);
  return force * (1 / (1 + response * length(force) / speed));
}

/// Computes the force on each triangle of an object.
struct AirOnTriangle {
  const int* triangles;  ///< vertex indices, three for each triangle
  const Record *positions, *velocities;
  Vec3f air;      ///< air velocity [m/s]
  Vec3f gravity;  ///< gravity that the velocities of dynamic particles do not include yet [m/s]
  float h, air_density, drag, lift;
  Vec3f* forces;  ///< force on each triangle [N]

  PLIANT_HD void operator()(int t) const {
    const int* corner = triangles + static_cast<std::ptrdiff_t>(3) * t;
    Vec3f x[3], velocity{};
    float inverse_masses = 0;
    for (int i = 0; i < 3; ++i) {
      const Record &p = positions[corner[i]], &v = velocities[corner[i]];
      x[i] = {p.x, p.y, p.z};
      velocity += Vec3f{v.x, v.y, v.z} + (p.w > 0 ? gravity : Vec3f{});
      inverse_masses = i == 0 ? p.w : inverse_masses + p.w;
    }
    const float third = 1.f / 3;
    forces[t] = air_force(x, air - velocity * third, air_density, drag, lift, 2 * h * (inverse_masses * third));
  }
};

/// Adds h f / m to a particle's velocity, where f is a third of the force on each of its triangles.
struct AirOnParticle {
  const int *corner_begin, *corners;  ///< triangle corners at each particle: Surface::corner_begin and corners
  const Vec3f* forces;                ///< force on each triangle [N]
  const Record* positions;
  float h;
  Record* velocities;

  PLIANT_HD void operator()(int i) const {
    Vec3f sum{};
    for (int c = corner_begin[i]; c < corner_begin[i + 1]; ++c) sum += forces[corners[c] / 3];
    const Vec3f change = sum * (h * positions[i].w * (1.f / 3));
    Record& v = velocities[i];
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
