// Visits constraints one by one for measurements, which change nothing (measure.cpp, sweeps/record.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "model/compiled_object.h"
#include "pliant/report.h"
#include "solver/project.h"

namespace pliant {

/// Statistics of constraint errors.
struct ErrorSum {
  double squares = 0, largest = 0;
  std::int64_t count = 0;

  void add(double error) {
    squares += error * error;
    largest = std::max(largest, std::fabs(error));
    ++count;
  }
  double rms() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0; }
  Residual residual(const std::string& type) const { return {type, count, rms(), largest}; }
};

/// The position of a constraint in its object: pool, batch and lane.
struct ConstraintPlace {
  const Pool& pool;
  int pool_number;
  std::int64_t batch;
  int lane;

  float value(int row) const { return pool.row(row, batch)[lane]; }
  /// The index of the multiplier of one component of C in its pool's array.
  std::int64_t multiplier_place(int component) const { return multiplier_index(pool, batch, lane, component); }
};

/// The scaled compliance alpha / h^2 of a constraint, limited as in projections.
inline double softness(const ConstraintPlace& at, double inverse_h2) {
  return std::min(double(at.value(at.pool.fields)) * inverse_h2, double(largest_compliance));
}

/// The arguments of a constraint type's functions as plain arrays (pliant/constraint.h), in float or double.
template <class R>
struct StencilArrays {
  R slots[4 * most_slots] = {}, rest[most_rest_fields] = {}, c[most_components] = {};
  R gradients[3 * most_slots * most_components] = {};

  void load_rest(const ConstraintPlace& at) {
    for (int field = 0; field < at.pool.fields; ++field) rest[field] = static_cast<R>(at.value(field));
  }
  void set_slot(int slot, R x, R y, R z, R w) {
    slots[4 * slot] = x;
    slots[4 * slot + 1] = y;
    slots[4 * slot + 2] = z;
    slots[4 * slot + 3] = w;
  }
  Vec3<R> gradient(const Pool& pool, int component, int slot) const {
    const R* at = gradients + 3 * (component * pool.stencil + slot);
    return {at[0], at[1], at[2]};
  }
};

/// Calls visit(place, particle indices by slot) for every constraint of a segment.
template <class Visit>
void for_segment(const CompiledObject& object, const Segment& segment, const Visit& visit) {
  const Pool& pool = object.pools[segment.pool];
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      std::int32_t number[most_slots];
      for (int slot = 0; slot < pool.stencil; ++slot) number[slot] = particle_of(segment, index, slot, lane);
      visit(ConstraintPlace{pool, segment.pool, std::int64_t{segment.first_batch} + b, lane}, number);
    }
  }
}

/// Calls visit(place, particle indices by slot) for every constraint of type `type`, in the order of the schedule.
/// Indices from object.particles on denote frames.
template <class Visit>
void for_constraints(const CompiledObject& object, int type, const Visit& visit) {
  for (const Segment& segment : object.segments)
    if (object.pools[segment.pool].type == type) for_segment(object, segment, visit);
}

}  // namespace pliant
