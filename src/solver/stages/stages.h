// The stages of a substep in the order of solver/step.cpp, one file each.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Starts a frame of `dt` seconds. Returns the first substep of each group of objects.
std::vector<Substep> begin_frame(const StepContext& context, double dt);

/// True if each group can make its substeps without regard to the others: there are several, none uses memory that
/// another one uses, and if the frame may be stopped, all reach the same time at each quarter.
bool may_run_side_by_side(const std::vector<Substep>& groups);

/// Moves colliders to their poses at the substep's end, and lets rest data and pressures follow their keyframes.
void control(Substep& s);

/// Adds wind and force fields to velocities.
void apply_forces(Substep& s);

/// v += h g, displacement = h v; moves kinematic particles to their targets. Finds contacts of particles with colliders
/// along the predicted paths. Returns false if a deferred update of the last substep found a non-finite value.
bool predict(Substep& s);

/// Finds contacts between surfaces.
void collide(Substep& s);

/// Projects all constraints and contacts, iteration by iteration.
void solve(Substep& s);

/// Solves chains and contacts in turn once more where surfaces press on one another (stages/solve_again.cpp).
void solve_again(Substep& s);

/// Shortens the few distances that the iterations left far too long (stages/limit.cpp).
void limit(Substep& s);

/// Truncates displacements that would make surfaces cross.
void filter(Substep& s);

/// After the filter: holds bodies that its result leaves in the way, moves free groups by what their centre of mass
/// lags (group_lag.h), and takes out of velocities what is not to become velocity.
void end_filter(Substep& s);

/// Where a quarter of a frame has more substeps than the last one, limits the share of corrections that becomes
/// velocity so that the substep does not increase energy (stages/guard_energy.cpp).
void guard_energy(Substep& s);

/// The same for each set of objects that are in contact with rigid bodies (stages/guard_bodies.cpp).
void guard_bodies(Substep& s);

/// After both guards: adds to the Report what momentum they take (stages/note_guards.cpp).
void note_guards(Substep& s);

/// Rest data of plastic constraints follow what is deformed too far.
void yield(Substep& s);

/// Updates velocities by the corrections, x += displacement, and applies restitution at colliders; joints of fast
/// wheels hold velocities, too. Returns false if a displacement is not finite; then the report names it, and the State
/// has been made finite.
bool update(Substep& s);

/// Applies restitution between surfaces.
void respond(Substep& s);

/// Counts the contacts of a substep after which the frame may end.
void count_contacts(Substep& s);

/// Adds the reports of the groups to the frame's, and sets the State's time, which all have reached. If a value is not
/// finite, finds its origin, makes the State finite, and returns false.
bool end_frame(std::vector<Substep>& groups, Report& report);

}  // namespace pliant
