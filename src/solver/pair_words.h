// What a Report says in words of contacts among things that move.
#pragma once

#include <string>
#include <vector>

#include "collision/pairs.h"
#include "model/model.h"

namespace pliant {

/// Appends a line for each two objects that are tangled, which names the first edge and triangle in the user's numbers, and one
/// where something is pinched. As many lines as there are pairs of objects at most.
void warn_of_pairs(const Model& model, const PairSystem& pairs, std::vector<std::string>& warnings);

}  // namespace pliant
