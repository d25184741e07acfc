// Mesh colliders that particles meet as solids: grids measured where none is given, and ground.
#pragma once

#include <memory>

#include "collision/fields/solid_field.h"

namespace pliant {

/// Of a collider `as` a distance grid or a heightfield. Throws Error naming what the mesh lacks.
std::shared_ptr<const SolidField> solid_field_of(const MeshCollider& collider);

/// Throws Error where solid_field_of would, without measuring anything.
void require_solid(const MeshCollider& collider);

}  // namespace pliant
