// Makes grains: particles, each with the mass of a sphere.
#include "pliant/grains.h"

#include <cmath>
#include <string>

#include "matter/require_option.h"
#include "matter/spare_particles.h"
#include "pliant/error.h"

namespace pliant {

Object make_grains(const std::vector<Vec3f>& positions, const GrainsOptions& options) {
  constexpr float sphere = 4.18879020f;  // 4/3 pi: volume over the cube of the radius
  const Grains& grains = options.grains;
  if (positions.empty() && options.capacity == 0)
    throw Error({.object = options.name}, "grains without particles", "give a position or more");
  require_option(grains.radius > 0, options.name, "radius", grains.radius, "positive, finite radius [m]");
  require_option(grains.density > 0, options.name, "density", grains.density, "positive, finite density [kg/m^3]");
  require_option(grains.friction >= 0, options.name, "friction", grains.friction,
                 "finite coefficient of 0 or more [-]");
  require_option(grains.cohesion >= 0, options.name, "cohesion", grains.cohesion,
                 "finite tensile stress of 0 or more [Pa]");
  Object object;
  object.name = options.name;
  object.positions = positions;
  object.flow = options.flow;
  add_spare(options.capacity, object);
  object.masses.assign(object.positions.size(),
                       sphere * grains.density * grains.radius * grains.radius * grains.radius);
  if (length_squared(options.velocity) > 0) object.velocities.assign(object.positions.size(), options.velocity);
  object.grains = grains;
  object.thickness = grains.radius;
  object.collides = true;
  object.static_friction = object.kinetic_friction = grains.friction;
  object.colour = {0.60f, 0.42f, 0.22f};
  return object;
}

}  // namespace pliant
