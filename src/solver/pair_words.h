// What a Report says in words of contacts among things that move.
#pragma once

#include <string>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"

namespace pliant {

/// Appends a line for each two objects that are tangled and one for each two that are pinched, which names the first edge and triangle,
/// or pair, in the user's numbers. As many lines as there are pairs of objects at most.
void warn_of_pairs(const Model& model, const SurfaceContact& pairs, std::vector<std::string>& warnings);

}  // namespace pliant
