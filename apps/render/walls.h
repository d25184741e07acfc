// Walls: planes that are steep, as those of a tank.
#pragma once

#include <vector>

#include "geometry.h"

namespace pliant::render {

/// True for a plane nearer to upright than to level.
bool is_wall(const RenderCollider& collider);

/// Makes a wall. It ends where other planes cut it and a little above the middle `around` of what a picture shows, so
/// that walls look like a tank and their shadows leave light in it; under a ceiling they reach up to it. `radius` is
/// that of what the picture shows [m].
Geometry build_wall(const RenderCollider& wall, const std::vector<RenderCollider>& colliders, const Vec3f& around,
                    float radius);

}  // namespace pliant::render
