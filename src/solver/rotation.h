// Orientations in a substep: predicted as free rigid bodies turn, corrected by constraints (stencil.h), then the angular velocity from
// the corrections.
//
// Angular velocity lives along the frame's own axes and changes by increments: rounding then does not add up to a drift of the energy.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Gyroscopic torque by the implicit midpoint rule in two fixed-point steps, then the rotation of the substep.
void predict_frames(Substep& s);

/// omega += corrections / h, less what the object's damping takes. Workspace::frames says whether all is finite.
void update_frames(Substep& s);

}  // namespace pliant
