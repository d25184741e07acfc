// Describes contacts between dynamic objects for a Report.
#pragma once

#include <string>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"

namespace pliant {

/// Appends a warning for each two objects with initial intersections, and one for each two with unresolvable pairs. A
/// warning names the first edge and triangle, or the first pair, by the user's indices.
void warn_of_pairs(const Model& model, const SurfaceContact& pairs, std::vector<std::string>& warnings);

}  // namespace pliant
