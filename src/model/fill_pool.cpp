#include "model/fill_pool.h"

#include "constraints/registry.h"

namespace pliant {

std::vector<Row> rows_of(const ConstraintList& list) {
  std::vector<Row> rows;
  rows.reserve(static_cast<std::size_t>(list.fields) + 2);
  for (int field = 0; field < list.fields; ++field) rows.push_back(list.rest.row(field, list.fields));
  rows.push_back(list.response.row(0, 1));
  if (list.law == Law::damped) rows.push_back(list.damping.row(0, 1));
  return rows;
}

namespace {

/// True if a row has equal values. Zeros of either sign count as equal: ordering a hinge's points can change the sign
/// of its rest angle.
bool is_constant(const Row& row, int count) {
  for (int i = 1; i < count; ++i) {
    if (row.at(i) != row.at(0)) return false;
  }
  return true;
}

}  // namespace

Pool make_pool(const ConstraintList& list) {
  Pool pool;
  pool.type = list.type;
  pool.law = list.law;
  pool.stencil = list.size;
  pool.components = list.components;
  pool.fields = list.fields;
  pool.in_lanes = list.in_lanes;
  pool.is_length = is_length(list.type);
  pool.constraints = list.count();
  const bool may_change = list.changes || constraint_type(list.type).acts_on_motion;  // motors get new targets
  for (const Row& row : rows_of(list)) {
    const bool is_rest = static_cast<int>(pool.row_offset.size()) < list.fields;
    const bool constant = is_constant(row, list.count()) && !(may_change && is_rest);
    pool.constants.insert(pool.constants.end(), batch_width, row.at(0));
    pool.row_offset.push_back(constant ? -1 : pool.block_floats);
    pool.block_floats += constant ? 0 : batch_width;
  }
  return pool;
}

}  // namespace pliant
