// What every way of laying out a pool begins with: which numbers its constraints have.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// The rows of a list in the order in which a pool has them; valid until the list changes.
std::vector<Row> rows_of(const ConstraintList& list);

/// A pool for a list, still without a batch: rows that are the same for every constraint are kept once.
Pool make_pool(const ConstraintList& list);

}  // namespace pliant
