// Describes contacts between dynamic objects for a Report.
#pragma once

#include <string>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"

namespace pliant {

/// Appends a line for each two objects with initial intersections, and one for each two with unresolvable pairs. A line
/// names the first edge and triangle, or the first pair, in the user's order.
void warn_of_pairs(const Model& model, const SurfaceContact& pairs, std::vector<std::string>& warnings);

}  // namespace pliant
