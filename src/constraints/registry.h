// Every constraint type by its number: those of all.h in their order, then those that users have registered.
#pragma once

#include <string>

#include "pliant/constraint.h"

namespace pliant {

int constraint_type_count();

/// `type` from 0 to constraint_type_count() - 1. The reference stays valid.
const ConstraintDefinition& constraint_type(int type);

/// The number of a type, or -1.
int find_constraint_type(const std::string& name);

/// "distance, dihedral_bending, ...".
std::string constraint_type_names();

/// The first type that is a length: what attachments are made of.
int length_type();

/// Whether C of a type is the distance of its two points less rest field 0.
inline bool is_length(int type) { return constraint_type(type).is_length; }
bool is_length(const std::string& name);

/// Whether a type bends two triangles about their common edge (points: the edge's ends, then the tips).
bool is_hinge(const std::string& name);
/// Whether such a type has a flat rest shape whatever the rest data are.
bool is_flat_hinge(const std::string& name);
/// The angle between two such triangles, 0 where they are flat [rad].
double fold_angle(const Vec3d (&x)[4]);

}  // namespace pliant
