#include "solver/gases/balloon.h"

#include "math/vector.h"
#include "parallel/launch.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Gathers for each particle what the pressure, linear over each of its triangles, pushes it.
struct LiftOnParticle {
  const int *triangles, *corner_begin, *corners;
  const Record* positions;
  Vec3f origin;   ///< about which pressure is measured: of a closed surface it does not matter
  Vec3f density;  ///< times gravity: the gradient of the pressure outside over that inside [Pa/m]
  float h;
  Record* velocities;

  PLIANT_HD Vec3f place(int i) const { return Vec3f{positions[i].x, positions[i].y, positions[i].z} - origin; }

  PLIANT_HD void operator()(int i) const {
    if (!(positions[i].w > 0)) return;
    const float own = dot(density, place(i));
    Vec3f sum{};
    for (int c = corner_begin[i]; c < corner_begin[i + 1]; ++c) {
      const int* corner = triangles + static_cast<std::ptrdiff_t>(corners[c] >> 2) * 3;
      const Vec3f a = place(corner[0]), b = place(corner[1]), d = place(corner[2]);
      const Vec3f area = cross(b - a, d - a) * 0.5f;
      sum += area * ((own + dot(density, a) + dot(density, b) + dot(density, d)) * (-1.f / 12));
    }
    const Vec3f change = sum * (h * positions[i].w);
    Record& v = velocities[i];
    v = {v.x + change.x, v.y + change.y, v.z + change.z, 0};
  }
};

}  // namespace

void lift_balloon(Substep& s, int object) {
  const CompiledObject& of = s.model.objects[static_cast<std::size_t>(object)];
  const int first = s.model.first[static_cast<std::size_t>(object)];
  const Record* positions = s.state.positions.data() + first;
  const Record& origin = positions[of.surface.triangles.front()[0]];
  launch(s.context.executor, "forces: lift", of.particles,
         LiftOnParticle{of.surface.triangles.front().data(), of.surface.corner_begin.data(), of.surface.corners.data(),
                        positions, Vec3f{origin.x, origin.y, origin.z}, s.model.gravity * of.volume.lift, s.h,
                        s.state.velocities.data() + first});
}

}  // namespace pliant
