// Converts mesh colliders to solids for contact with particles: heightfields and distance grids.
#pragma once

#include <memory>

#include "collision/fields/solid_field.h"

namespace pliant {

/// Makes the distance grid or heightfield that a collider asks for. Throws an Error that names what the mesh lacks.
std::shared_ptr<const SolidField> solid_field_of(const MeshCollider& collider);

/// Throws the Error that solid_field_of would throw, without computing any distance.
void require_solid(const MeshCollider& collider);

}  // namespace pliant
