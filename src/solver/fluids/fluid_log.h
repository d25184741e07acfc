// Adds the pressure of a liquid on walls and bodies to the contact log.
#pragma once

#include "solver/contact_log.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/fluids/fluid_walls.h"

namespace pliant {

struct Substep;

/// After the multipliers of a projection: by Newton's third law, a wall gets the opposite of what its share in the
/// density of a particle moves that particle, times the particle's mass over the substep.
void log_pressure(const Substep& s, const FluidPool& pool, const FluidBounds& bounds, ContactLog& log);

}  // namespace pliant
