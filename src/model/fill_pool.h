// The common start of every pool layout: the rows of its constraints.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// The rows of a list in pool order; valid until the list changes.
std::vector<Row> rows_of(const ConstraintList& list);

/// A pool for a list without batches; constant rows are stored once.
Pool make_pool(const ConstraintList& list);

}  // namespace pliant
