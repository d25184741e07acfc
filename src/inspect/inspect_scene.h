// Validates a scene before it is compiled.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Least length of a substep [s]: compliance divided by the square of a shorter one could overflow a float.
constexpr double shortest_substep = 1e-12;
/// Most substeps of a frame that can be set (Settings::substeps).
constexpr double most_substeps_of_frame = 10000;

/// For each particle of the user: 1 if a pin, an infinite mass or a rigid attachment holds it, else 0. `gravity`: its
/// magnitude [m/s^2].
std::vector<char> held_particles(const Object& object, double gravity);

/// Throws an Error for the first grave finding of inspect(scene); it names object and element. It makes no other
/// checks, so it costs one pass over the data. Afterwards the scene can be compiled without checks of indices, sizes
/// and ranges.
void refuse_grave(const Scene& scene);

/// refuse_grave without checks of initial positions, for objects that were added at different times and have moved.
void refuse_grave_but_places(const Scene& scene);

/// Throws an Error for the first grave finding about an object or collider that is added to a World.
void refuse_grave(const Object& object);
void refuse_grave(const Collider& collider);
void refuse_grave(const MeshCollider& collider);

/// Throws an Error for initial intersections and enclosures, if the scene's settings refuse them; makes no other
/// checks.
void refuse_initial_intersections(const Scene& scene);

/// For each liquid, gas or grains with particles that start inside primitive colliders or rigid bodies: a warning with
/// their number.
std::vector<std::string> warnings_of_starts_in_solids(const Scene& scene);

/// For each soft body that the substeps of `settings` leave over a tenth softer than its modulus says: a warning with
/// how much, and what mends it. `pliant check` says the same.
std::vector<std::string> warnings_of_soft_bodies(const Scene& scene, const Settings& settings);
/// For each woven cloth whose triangles yield much more than their stiffness says with these settings: a warning with
/// by how much.
std::vector<std::string> warnings_of_woven(const Scene& scene, const Settings& settings);
/// For each sheet whose hinges bend much further than their stiffness says with these settings: a warning with by how
/// much.
std::vector<std::string> warnings_of_hinges(const Scene& scene, const Settings& settings);
/// For each object that hangs by the sweep multigrid and stretches much further than its stiffness says: a warning with
/// by how much.
std::vector<std::string> warnings_of_multigrid(const Scene& scene, const Settings& settings);
/// For each sheet that is held at all edges and whose mesh is so coarse that it bends much further than its stiffness
/// says: a warning with by how much.
std::vector<std::string> warnings_of_plates(const Scene& scene, const Settings& settings);
/// For each sheet whose particles are over 10 000 times as heavy as those of one that it can press on: a warning with
/// how many times, as frames may take ten times as long.
std::vector<std::string> warnings_of_masses(const Scene& scene);

}  // namespace pliant
