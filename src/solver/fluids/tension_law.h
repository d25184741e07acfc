// The surface energy of a liquid, as a sum over its particles.
#pragma once

namespace pliant {

/// A particle counts its neighbours within `reach` by (1 - r^2 / reach^2)^2. Where the sum c, over that inside a
/// lattice, is below `full`, the particle has the energy sigma `energy` (full - c)^2 / 2. So only particles near a
/// surface attract their neighbours, and inside a liquid there is no attraction that would make a solid of it. Forces
/// are along pairs: linear and angular momentum are kept.
struct TensionLaw {
  float reach = 0;           ///< [m]
  float own = 0;             ///< c of a particle alone [-]
  float count_scale = 0;     ///< of a neighbour, so that c is 1 inside a lattice [-]
  float full = 0;            ///< [-]
  float energy = 0;          ///< [m^2]
  float gradient_scale = 0;  ///< of a pair's force, from the gradient of the count [1/m^2]
  float stiffness = 0;       ///< h^2 sigma / (mass of a particle) must stay below it for stability [-]
};

/// The law of a liquid whose particles are `spacing` [m] apart at rest.
TensionLaw tension_law(float spacing);

/// What a wall is to a particle near it. W is the share of the count that lies beyond the wall's plane: the particle
/// counts `count` W more, and has the energy -sigma `energy` W. Both make the boundary of liquid and wall cheaper, so
/// that it has the energy -sigma cos(contact angle) an area, as Young's law wants. Counting alone pins the edges of
/// drops on the lattice of their particles, and so does the energy alone.
struct WettingLaw {
  float count = 0;   ///< share of a liquid that the wall stands for [-]
  float energy = 0;  ///< [m^2]
};

/// The law of a liquid with a contact angle, from 0 to 180 [degrees].
WettingLaw wetting_law(float spacing, float contact_angle);

/// The share of the integral of (1 - r^2)^2 over the unit ball beyond a plane at distance t, from 0 to 1, from its
/// centre.
double share_beyond_plane(double t);
/// Its derivative; negative.
double slope_beyond_plane(double t);

}  // namespace pliant
