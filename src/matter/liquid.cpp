// Makes a liquid: particles, each with the mass of a cube whose side is the spacing.
#include "pliant/liquid.h"

#include <cmath>
#include <string>

#include "matter/spare_particles.h"
#include "pliant/error.h"

namespace pliant {

namespace {

bool is_positive(float a) { return a > 0 && std::isfinite(a); }

void require_positive(const std::string& name, const char* element, float value, const char* what) {
  if (!is_positive(value))
    throw Error({.object = name, .element = element}, "is " + std::to_string(value),
                std::string("give a positive, finite ") + what);
}

}  // namespace

Object make_liquid(const std::vector<Vec3f>& positions, const LiquidOptions& options) {
  const Fluid& fluid = options.fluid;
  if (positions.empty() && options.capacity == 0)
    throw Error({.object = options.name}, "a liquid without particles", "give a position or more");
  require_positive(options.name, "spacing", fluid.spacing, "distance of particles [m]");
  require_positive(options.name, "density", fluid.density, "density [kg/m^3]");
  if (!(fluid.speed_of_sound >= 0) || !std::isfinite(fluid.speed_of_sound))
    throw Error({.object = options.name, .element = "speed_of_sound"}, "is " + std::to_string(fluid.speed_of_sound),
                "give a positive speed [m/s], or 0 for a liquid that does not yield");
  if (!(fluid.viscosity >= 0) || !std::isfinite(fluid.viscosity))
    throw Error({.object = options.name, .element = "viscosity"}, "is " + std::to_string(fluid.viscosity),
                "give a positive viscosity [Pa s], or 0 for none");
  if (!(fluid.surface_tension >= 0) || !std::isfinite(fluid.surface_tension))
    throw Error({.object = options.name, .element = "surface_tension"}, "is " + std::to_string(fluid.surface_tension),
                "give a positive tension [N/m], or 0 for none");
  if (!(fluid.contact_angle >= 0) || !(fluid.contact_angle <= 180))
    throw Error({.object = options.name, .element = "contact_angle"}, "is " + std::to_string(fluid.contact_angle),
                "give an angle from 0 to 180 [degrees]; 180 is no adhesion");
  if (!(fluid.vorticity >= 0) || !std::isfinite(fluid.vorticity))
    throw Error({.object = options.name, .element = "vorticity"}, "is " + std::to_string(fluid.vorticity),
                "give a positive coefficient of confinement [m/s], or 0 for none");
  if (!(fluid.clarity >= 0) || !std::isfinite(fluid.clarity))
    throw Error({.object = options.name, .element = "clarity"}, "is " + std::to_string(fluid.clarity),
                "give a positive length [m], or 0 for one by the size of the picture");
  Object liquid;
  liquid.name = options.name;
  liquid.positions = positions;
  liquid.flow = options.flow;
  add_spare(options.capacity, liquid);
  liquid.masses.assign(liquid.positions.size(), fluid.density * fluid.spacing * fluid.spacing * fluid.spacing);
  if (length_squared(options.velocity) > 0) liquid.velocities.assign(liquid.positions.size(), options.velocity);
  liquid.fluid = fluid;
  liquid.thickness = fluid.spacing / 2;
  liquid.collides = true;
  liquid.static_friction = liquid.kinetic_friction = 0;
  liquid.colour = {0.1f, 0.3f, 0.6f};
  return liquid;
}

}  // namespace pliant
