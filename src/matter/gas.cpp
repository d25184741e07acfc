// Makes gases and tracers.
#include "pliant/gas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "matter/require_option.h"
#include "pliant/error.h"
#include "pliant/liquid.h"

namespace pliant {

namespace {

struct Preset {
  const char* name;
  float density, diffusivity, temperature;
};

// Ideal gases of 28.96 and 4.003 g/mol; conductivity over heat capacity and density from the CRC Handbook (0.0259 and
// 0.152 W/(m K)).
constexpr float room = 293.15f;
constexpr std::array<Preset, 3> presets{
    {{"air", 1.204f, 2.1e-5f, room}, {"smoke", 1.204f, 2.1e-5f, 400}, {"helium", 0.166f, 1.8e-4f, room}}};

}  // namespace

GasOptions gas_preset(std::string_view name) {
  const auto found = std::find_if(presets.begin(), presets.end(), [&](const Preset& one) { return one.name == name; });
  if (found == presets.end())
    throw Error({.element = "gas '" + std::string(name) + "'"}, "is unknown", "use air, smoke or helium");
  GasOptions options;
  options.name = found->name;
  options.fluid.density = found->density;
  options.gas.temperature = found->temperature;
  options.gas.diffusivity = found->diffusivity;
  options.gas.ambient_density = presets.front().density;
  return options;
}

Object make_gas(const std::vector<Vec3f>& positions, const GasOptions& options) {
  const Gas& gas = options.gas;
  require_option(gas.temperature > 0, options.name, "temperature", gas.temperature, "positive temperature [K]");
  require_option(gas.ambient_temperature > 0, options.name, "ambient_temperature", gas.ambient_temperature,
                 "positive temperature [K]");
  require_option(gas.ambient_density >= 0, options.name, "ambient_density", gas.ambient_density,
                 "density of 0 or more [kg/m^3]");
  require_option(gas.cooling_time >= 0, options.name, "cooling_time", gas.cooling_time, "time of 0 or more [s]");
  require_option(gas.diffusivity >= 0, options.name, "diffusivity", gas.diffusivity,
                 "diffusivity of 0 or more [m^2/s]");
  require_option(gas.drag >= 0, options.name, "drag", gas.drag, "rate of 0 or more [1/s]");
  require_option(gas.vorticity >= 0, options.name, "vorticity", gas.vorticity, "coefficient of 0 or more [m/s]");
  Object object = make_liquid(positions, {.name = options.name, .fluid = options.fluid, .velocity = options.velocity});
  object.gas = gas;
  object.colour = {0.75f, 0.75f, 0.78f};
  return object;
}

Volume filled_with(const GasOptions& gas, float mass, double rest_volume) {
  constexpr double pressure_of_air = 101325;  // [Pa]
  require_option(mass > 0, gas.name, "mass", mass, "positive mass [kg]");
  require_option(rest_volume > 0, gas.name, "rest_volume", static_cast<float>(rest_volume), "positive volume [m^3]");
  const double density = static_cast<double>(gas.fluid.density) * static_cast<double>(gas.gas.ambient_temperature) /
                         static_cast<double>(gas.gas.temperature);
  const double volume = static_cast<double>(mass) / density;
  Volume of;
  of.pressure = static_cast<float>(volume / rest_volume);
  // Near the pressure of the air, an ideal gas yields as a spring of that bulk modulus; C is six volumes.
  of.stiffness = Stiffness::compliance(static_cast<float>(36 * volume / pressure_of_air));
  of.lift = gas.gas.ambient_density - static_cast<float>(density);
  return of;
}

Object make_tracers(const TracersOptions& options) {
  constexpr float weightless = 1e-6f;  // no force acts on them, but constraints need a mass [kg]
  constexpr int most = 1 << 24;
  const Tracers& tracers = options.tracers;
  if (options.capacity < 1 || options.capacity > most)
    throw Error({.object = options.name, .element = "capacity"}, "is " + std::to_string(options.capacity),
                "give 1 to " + std::to_string(most));
  require_option(tracers.rate > 0, options.name, "rate", tracers.rate, "positive rate [1/s]");
  require_option(tracers.lifetime > 0, options.name, "lifetime", tracers.lifetime, "positive time [s]");
  Object object;
  object.name = options.name;
  object.positions.assign(static_cast<std::size_t>(options.capacity), tracers.source.centre);
  object.masses.assign(object.positions.size(), weightless);
  object.tracers = tracers;
  object.thickness = 0;
  object.static_friction = object.kinetic_friction = 0;
  object.colour = {0.8f, 0.8f, 0.8f};
  return object;
}

}  // namespace pliant
