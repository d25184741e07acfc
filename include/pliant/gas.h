// Gases as particles with a temperature, and tracers that they carry along.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Options of make_gas. `fluid` has the density at the ambient temperature, and the speed of sound.
struct GasOptions {
  std::string name = "gas";
  Fluid fluid{.spacing = 0.05f, .density = 1.2f};
  Gas gas{};
  Vec3f velocity{};  ///< at the start [m/s]
};

/// Density at 293.15 K and 101 325 Pa, and diffusivity of heat, of "air", "smoke" (hot air: 400 K) or "helium",
/// surrounded by air. For any other name throws an Error that lists the names.
GasOptions gas_preset(std::string_view name);

/// Makes a gas of particles at given places, about a spacing apart: fill_box of pliant/liquid.h gives such places. Each
/// has the mass of a cube of that side, and touches colliders, cloth and bodies at half the spacing, without friction.
/// Throws an Error that names an option that is out of range.
Object make_gas(const std::vector<Vec3f>& positions, const GasOptions& options = {});

/// The volume constraint of a closed surface that holds a mass of gas [kg], of an ideal gas in air of 101 325 Pa.
/// `rest_volume` is that of the surface's mesh [m^3]. A slack surface takes the volume that the gas has in the air,
/// mass T / (density T_ambient); one that holds it back has a pressure inside. The air bears it up. Throws an Error if
/// the mass or the volume is not positive and finite.
Volume filled_with(const GasOptions& gas, float mass, double rest_volume);

/// Options of make_tracers.
struct TracersOptions {
  std::string name = "smoke";
  Tracers tracers{};
  int capacity = 10000;  ///< most tracers at a time; a new one then replaces the oldest
};

/// Makes tracers, none of which is there at the start. They meet colliders, and have the velocity of the gases that
/// they meet by groups and masks. Throws an Error that names an option that is out of range.
Object make_tracers(const TracersOptions& options = {});

}  // namespace pliant
