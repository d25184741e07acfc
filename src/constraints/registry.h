// Constraint types by number: first those of all.h in order, then those that users register.
#pragma once

#include <string>

#include "pliant/constraint.h"

namespace pliant {

int constraint_type_count();

/// The definition of constraint type `type`, from 0 to constraint_type_count() - 1. The reference stays valid.
const ConstraintDefinition& constraint_type(int type);

/// The number of the constraint type with this name, or -1.
int find_constraint_type(const std::string& name);

/// All names as a list for messages: "distance, dihedral_bending, ...".
std::string constraint_type_names();

/// The number of the first constraint type with is_length; attachments are of this type.
int length_type();

/// True if C of the type is the distance of its two points minus rest field 0.
inline bool is_length(int type) { return constraint_type(type).is_length; }
bool is_length(const std::string& name);

/// True if this constraint type bends two triangles about their edge (points: ends of the edge, then the tips).
bool is_hinge(const std::string& name);
bool is_hinge(int type);
/// True if a hinge of this type always has a flat rest shape, whatever its rest data.
bool is_flat_hinge(const std::string& name);
/// The dihedral angle of a hinge, given by the ends of its edge and then its tips; 0 if flat [rad].
double fold_angle(const Vec3d (&x)[4]);

}  // namespace pliant
