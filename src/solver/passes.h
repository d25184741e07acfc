// Passes over the constraints of the objects that are swept (is_swept in substep.h): what sweeps are made of.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Which way the schedule is walked.
enum class Order { forward, backward };

/// One projection of the constraints inside a tile; inside every tile; between tiles.
void sweep_tile(const Substep& s, int task, bool first_pass, Order order);
void sweep_tiles(Substep& s, bool first_pass, Order order);
void sweep_inter_tile(Substep& s, bool first_pass, Order order);

/// One projection of every volume, and of every contact with a collider: edges and triangles, then particles.
void sweep_volumes(Substep& s, bool first_pass);
void sweep_contacts(Substep& s);

/// One projection of every contact among surfaces.
void sweep_pairs(Substep& s);

/// Finds contacts with colliders along what particles have moved since the prediction, beside those found then; for a sweep
/// that moves particles far.
void find_more_contacts(Substep& s);

/// Calls body(object, segment) for every segment of inter-tile constraints, colour after colour; those of one colour on all
/// threads where they are many.
void for_inter_tile(Substep& s, Order order, FunctionRef<void(int, const Segment*)> body);

}  // namespace pliant
