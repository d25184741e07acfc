// Makes the rows of a constraint pool, whatever its layout.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// The rows of a constraint list in the order of a pool's rows; valid until the list changes.
std::vector<Row> rows_of(const ConstraintList& list);

/// Makes a pool without batches for a list. Rows that are the same for all constraints are stored in it once.
Pool make_pool(const ConstraintList& list);

}  // namespace pliant
