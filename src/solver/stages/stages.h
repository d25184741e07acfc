// The stages of a substep in the order of solver/step.cpp, a file each.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// The first substep of a frame of dt seconds.
Substep begin_frame(const StepContext& context, double dt, Report& report);

/// Moves colliders to where the substep ends.
void control(Substep& s);

/// Wind and force fields change velocities.
void apply_forces(Substep& s);

/// v += h g, displacement = h v; kinematic particles go to their targets. Finds contacts with colliders of each tile's path.
/// False where the update that was left to it met a value that is not finite.
bool predict(Substep& s);

/// Contacts among surfaces.
void collide(Substep& s);

/// The iterations over all constraints.
void solve(Substep& s);

/// Truncates steps so that no surface crosses another.
void filter(Substep& s);

/// Velocities from the corrections, x += displacement, restitution at colliders. False where a displacement is not finite: the
/// report names it, and the state is finite again.
bool update(Substep& s);

/// Restitution among surfaces.
void respond(Substep& s);

/// Counts contacts and moves the clock.
void end_frame(Substep& s);

}  // namespace pliant
