// What every way of laying out a pool begins with: which numbers its constraints have.
#pragma once

#include <vector>

#include "model/gather_constraints.h"
#include "model/pool.h"

namespace pliant {

/// A row of numbers, one a constraint: a rest field, the responses or the dampings.
struct Row {
  const float* first;
  int stride;
  float at(int constraint) const { return first[static_cast<std::size_t>(constraint) * stride]; }
};

/// The rows of a list in the order in which a pool has them.
std::vector<Row> rows_of(const ConstraintList& list);

/// A pool for a list, still without a batch: rows that are the same for every constraint are kept once.
Pool make_pool(const ConstraintList& list);

}  // namespace pliant
