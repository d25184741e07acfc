// Surfaces that passed through one another in a trial run, because nothing makes contact between them.
#pragma once

#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant {

/// A warning for each object without self-collision whose triangles pass through one another now, and did not at the start;
/// and one for the first pair of objects that do so because `collides` is false, with the number of further pairs.
std::vector<std::string> passed_through(const Scene& scene, const World& world);

}  // namespace pliant
