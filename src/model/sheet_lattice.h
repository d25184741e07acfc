// The rest positions of a flat sheet before they were rounded to floats, where its vertices are on a lattice.
#pragma once

#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// The rest positions of an object's particles [m]. If all vertices of its triangles are on a lattice o + i a + j b but
/// for the rounding of floats, as those of grids are, they are put on the lattice that fits them best. Rows of K then
/// differ by the rounding of doubles alone, and so can be shared: K moves nothing in the plane at rest.
std::vector<Vec3d> unrounded_rest_positions(const Object& object);

/// Makes all values that are not zero their mean if they differ by less than 1e-4 of it: rounding of compliances.
void unify(std::vector<double>& rigidities);

}  // namespace pliant
