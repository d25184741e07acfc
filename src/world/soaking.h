// Liquid that soaks into surfaces, passes through them and drips off (Absorbency), between steps.
#pragma once

#include "pliant/report.h"
#include "world/world_data.h"

namespace pliant {

/// Lets the particles of all liquids come and go (Flow::open) if a surface takes up liquid. Call it when objects have
/// come, before their State is made; what has been open stays so.
void open_liquids(WorldData& world);

/// Does so for every liquid: some has soaked into a surface that is no more.
void open_all_liquids(WorldData& world);

/// The inverse mass of a particle of a surface that holds a mass of liquid [kg]; 0 stays 0.
inline float wet_inverse_mass(float dry, float water) { return dry > 0 && water > 0 ? 1 / (1 / dry + water) : dry; }

/// Sets the masses of an object with Absorbency by what it holds; those that the State has fixed stay so.
void set_wet_masses(WorldData& world, int number);

/// Moves liquid into, along, through and off all surfaces with Absorbency after a step of `dt` seconds, and counts the
/// particles. Then sets the masses of these surfaces. The sum of all masses stays, to rounding; so does the momentum of
/// what is free.
void soak(WorldData& world, double dt, FlowReport& report);

}  // namespace pliant
