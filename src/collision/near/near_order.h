// The order of near lists: by kind, then by bodies and clusters. Adding or removing a list keeps the order of contacts.
#pragma once

#include <vector>

#include "collision/near/neighbourhood.h"

namespace pliant {

/// True if a near list comes before another one.
bool is_before(const PairModel& model, const ClusterSides& list, const ClusterSides& other);

/// The near lists (kind and clusters) that these cluster pairs need, in order.
std::vector<ClusterSides> sides_of(const Neighbourhood& near, const std::vector<int>& pairs);

}  // namespace pliant
