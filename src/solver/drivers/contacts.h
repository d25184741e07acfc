// Projects contacts: with colliders tile by tile, between surfaces for all objects at once.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Projects every contact with a collider once: contacts of edges and triangles first, then contacts of particles. Only
/// for objects of the current group (is_swept in substep.h).
void sweep_contacts(Substep& s);

/// Projects every contact between surfaces once.
void sweep_pairs(Substep& s);

/// Calls visit(particle) for each point of the contacts with several points that push: of edges and triangles with colliders,
/// and between surfaces. Particles are numbered over all objects; one may come more than once.
void for_touching_points(const Substep& s, FunctionRef<void(int particle)> visit);

/// Adds contacts with colliders along the displacements since the prediction. For sweeps that move particles far from
/// it, such as multigrid.
void find_more_contacts(Substep& s);

/// Call after the last iteration: finds particles that constraints moved below a plane, and projects them onto it.
void hold_at_surfaces(Substep& s);

}  // namespace pliant
