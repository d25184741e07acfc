// Orientations in a substep: predicted as those of free rigid bodies, then corrected by constraints (stencil.h); the
// corrections change the angular velocity.
//
// Angular velocity is stored in the frame's own axes and changed by increments, so that rounding causes no energy
// drift.
#pragma once

#include "solver/motion_kernels.h"
#include "solver/substep.h"

namespace pliant {

/// The arrays of all frames.
FrameArrays frame_arrays(const Substep& s);

/// Predicts orientations: gyroscopic torque by the implicit midpoint rule in two iterations, then the substep's
/// rotation.
void predict_frames(Substep& s);

/// Updates angular velocities: omega += corrections / h, then damping. Sets Substep::frames_are_finite.
void update_frames(Substep& s);

}  // namespace pliant
