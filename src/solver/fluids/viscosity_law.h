// The viscous force between neighbours of a liquid, and between a particle and a wall.
#pragma once

namespace pliant {

/// A pair of particles at a distance r resists its rate of extension v: force mu scale w(q) v along the pair, with q =
/// reach - r and w = q (near + far q). The sum over a lattice or over neighbours in all directions is the stress of a
/// Newtonian liquid of viscosity mu.
struct ViscosityLaw {
  float reach = 0;  ///< twice the spacing [m]
  float near = 0;   ///< [m]
  float far = 0;    ///< so that a cubic lattice of particles is as viscous along its axes as across them [-]
  float scale = 0;  ///< [1/m]
  float area = 0;   ///< of a wall, per particle of a layer next to it [m^2]
};

/// The law of a liquid whose particles are `spacing` [m] apart at rest.
ViscosityLaw viscosity_law(float spacing);

/// The force on a particle at a distance d [m] from a wall, over the viscosity and its velocity along the wall [m].
float grip_of_wall(const ViscosityLaw& law, float distance);

}  // namespace pliant
