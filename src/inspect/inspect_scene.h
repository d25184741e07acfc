// What is wrong with a scene, found before anything is compiled.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// Below this the inverse square of a substep, which compliance is divided by, comes near the end of the floats [s].
constexpr double shortest_substep = 1e-12;

/// Throws Error for the first grave finding of inspect(scene), naming object and element. Looks for nothing else, so it
/// costs one pass over the scene's data. After it a scene may be compiled without further checks of indices, sizes and
/// ranges.
void refuse_grave(const Scene& scene);

/// The same, but for what depends on where surfaces begin: of a scene whose objects came at different times, and have moved since.
void refuse_grave_but_places(const Scene& scene);

/// The same for one thing that is added to a World.
void refuse_grave(const Object& object);
void refuse_grave(const Collider& collider);
void refuse_grave(const MeshCollider& collider);

/// Only of initial intersections and enclosures, and only where the scene's setting refuses them.
void refuse_initial_intersections(const Scene& scene);

}  // namespace pliant
