// Which constraint types give tetrahedra their shape.
#pragma once

#include <string>

#include "constraints/registry.h"

namespace pliant {

/// True if the type opposes any change of shape of a tetrahedron: tetrahedron_shear and its like, one for each of a
/// solid.
bool gives_shape(const std::string& name);
inline bool gives_shape(int type) { return gives_shape(constraint_type(type).name); }

/// True if constraints of the type make up an elastic solid: those that give shape, and those that keep volumes of
/// tetrahedra.
bool belongs_to_solid(int type);

}  // namespace pliant
