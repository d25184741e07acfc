// Mesh colliders as solids for particles: heightfields, and distance grids, which are measured unless given.
#pragma once

#include <memory>

#include "collision/fields/solid_field.h"

namespace pliant {

/// The solid of a collider that is a distance grid or a heightfield. Throws an Error that names what the mesh lacks.
std::shared_ptr<const SolidField> solid_field_of(const MeshCollider& collider);

/// Throws if solid_field_of would, without measuring anything.
void require_solid(const MeshCollider& collider);

}  // namespace pliant
