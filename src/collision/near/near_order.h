// The order of near lists: kind, then clusters by body. An added or removed list does not change the order of contacts.
#pragma once

#include <vector>

#include "collision/near/neighbourhood.h"

namespace pliant {

/// True if a list comes before another one.
bool is_before(const PairModel& model, const ClusterSides& list, const ClusterSides& other);

/// The sides of all near lists of these cluster pairs, in order.
std::vector<ClusterSides> sides_of(const Neighbourhood& near, const std::vector<int>& pairs);

}  // namespace pliant
