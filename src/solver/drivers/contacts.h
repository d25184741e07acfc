// Projects contacts: those of particles with colliders tile by tile, those between surfaces for all objects at once.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Projects every contact with a collider once: contacts of edges and triangles first, then contacts of particles.
/// Visits only objects of the current sweep group (is_swept in substep.h).
void sweep_contacts(Substep& s);

/// Projects every contact between surfaces once. Within a sweep group, only contacts of its objects.
void sweep_pairs(Substep& s);

/// Projects once more the contacts of the objects with has[object] != 0, for sweeps or passes over these alone: others
/// keep the bits that they have alone. Contacts among surfaces may then overlap by a share `yield` of their thickness,
/// but for those with a side that is at least twenty times as heavy as the other.
void project_contacts_of(Substep& s, const char* name, const std::vector<char>& has, float yield);

/// Calls visit(particle) for the points of active contacts with several points: of edges and triangles with colliders,
/// and between surfaces. Particles are numbered over all objects; one particle may be visited several times.
void for_touching_points(const Substep& s, FunctionRef<void(int particle)> visit);

/// Finds contacts with colliders along the displacements made since the prediction. For sweeps that move particles far
/// from the prediction, such as multigrid.
void find_more_contacts(Substep& s);

/// Call after the last iteration: finds particles that constraints moved below a plane, and projects them onto it.
void hold_at_surfaces(Substep& s);

}  // namespace pliant
