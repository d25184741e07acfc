// Validates a scene before it is compiled.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// A shorter substep could overflow a float: compliance is divided by its square [s].
constexpr double shortest_substep = 1e-12;

/// Throws an Error for the first grave finding of inspect(scene), with object and element. It searches for nothing
/// else, so the cost is one pass over the data. Afterwards the scene can be compiled without checks of indices, sizes
/// and ranges.
void refuse_grave(const Scene& scene);

/// The same without checks of initial positions, for a scene whose objects were added at different times and have moved.
void refuse_grave_but_places(const Scene& scene);

/// The same for one thing that is added to a World.
void refuse_grave(const Object& object);
void refuse_grave(const Collider& collider);
void refuse_grave(const MeshCollider& collider);

/// Checks only for initial intersections and enclosures, and only if the scene's settings reject them.
void refuse_initial_intersections(const Scene& scene);

}  // namespace pliant
