// Orientations in a substep: predicted as free rigid bodies, corrected by
// constraints (stencil.h). The corrections then update the angular velocity.
//
// Angular velocity is in the frame's axes and changes by increments, so rounding accumulates no energy drift.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Gyroscopic torque by the implicit midpoint rule in two fixed-point steps, then the substep's rotation.
void predict_frames(Substep& s);

/// omega += corrections / h, minus damping. Workspace::frames reports whether all values are finite.
void update_frames(Substep& s);

}  // namespace pliant
