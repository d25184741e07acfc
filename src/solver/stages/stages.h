// The stages of a substep in the order of solver/step.cpp, one file each.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Prepares the first substep of each group in a frame of dt seconds.
std::vector<Substep> begin_frame(const StepContext& context, double dt, Report& report);

/// Moves colliders to their poses at the substep's end.
void control(Substep& s);

/// Applies wind and force fields to velocities.
void apply_forces(Substep& s);

/// v += h g, displacement = h v; moves kinematic particles to their targets. Finds contacts with colliders along each
/// tile's path. Returns false if a deferred update met a non-finite value.
bool predict(Substep& s);

/// Finds contacts between surfaces.
void collide(Substep& s);

/// Iterates over all constraints.
void solve(Substep& s);

/// Truncates steps so that no surface crosses another.
void filter(Substep& s);

/// Velocities from corrections, x += displacement, restitution at colliders. Returns false for a non-finite displacement:
/// the report names it, and the State is finite again.
bool update(Substep& s);

/// Applies restitution between surfaces.
void respond(Substep& s);

/// Counts the contacts of a group's last substep.
void end_group(Substep& s);

/// Advances the time to that of all groups.
void end_frame(std::vector<Substep>& groups);

}  // namespace pliant
