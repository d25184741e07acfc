// Contacts, which are found in each substep: with colliders by tiles, among surfaces once for all objects.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// One projection of every contact with a collider: of edges and triangles, then of particles of the objects that are swept
/// (is_swept in substep.h).
void sweep_contacts(Substep& s);

/// One projection of every contact among surfaces.
void sweep_pairs(Substep& s);

/// Finds contacts with colliders along what particles have moved since the prediction, beside those found then; for a sweep
/// that moves particles far.
void find_more_contacts(Substep& s);

/// After the last iteration: finds contacts of particles that constraints moved below a plane, and projects them.
void hold_at_surfaces(Substep& s);

}  // namespace pliant
