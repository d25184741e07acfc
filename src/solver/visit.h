// Constraints one by one, for what looks at them and changes nothing: measure.cpp and sweeps/record.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "model/compiled_object.h"
#include "solver/project.h"

namespace pliant {

/// Sums up errors of constraints.
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

/// Where a constraint stands in its pool.
struct ConstraintPlace {
  const Pool& pool;
  int pool_number;
  std::int64_t batch;
  int lane;

  float value(int row) const { return pool.row(row, batch)[lane]; }
  std::int64_t lane_in_pool() const { return batch * batch_width + lane; }
};

/// Floats of a type's rest data, after which a pool's rows hold the response and the damping.
template <class T>
inline constexpr int rest_fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));

/// The rest data of a constraint of type T.
template <class T, class R>
typename T::template Params<R> rest_data(const ConstraintPlace& at) {
  R rest[rest_fields<T>];
  for (int field = 0; field < rest_fields<T>; ++field) rest[field] = static_cast<R>(at.value(field));
  typename T::template Params<R> params;
  static_assert(sizeof rest == sizeof params);
  std::memcpy(&params, rest, sizeof params);
  return params;
}

/// alpha / h^2 of a constraint of type T as a projection has it.
template <class T>
double softness(const ConstraintPlace& at, double inverse_h2) {
  return std::min(double(at.value(rest_fields<T>)) * inverse_h2, double(largest_compliance));
}

/// Calls visit(place, its particles) for every constraint of type T, number `type`, in the order of the schedule.
template <class T, class Visit>
void for_constraints(const CompiledObject& object, int type, const Visit& visit) {
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[segment.pool];
    if (pool.type != type) continue;
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
      for (int lane = 0; lane < batch_width; ++lane) {
        if (!lane_is_valid(segment, b, lane)) continue;
        std::int32_t particle[T::size];
        for (int slot = 0; slot < T::size; ++slot) particle[slot] = particle_of(segment, index, slot, lane);
        visit(ConstraintPlace{pool, segment.pool, std::int64_t{segment.first_batch} + b, lane}, particle);
      }
    }
  }
}

}  // namespace pliant
