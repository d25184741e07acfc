// For each particle, the constraints that act on it: their corrections are what a Jacobi sweep sums for the particle.
//
// Each constraint writes its corrections to places of its own. Each particle then sums its corrections in ascending
// order. So no atomics are needed, and any number of threads gives the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "model/compiled_object.h"

namespace pliant {

struct Incidence {
  std::vector<std::int32_t> begin;       ///< particle p owns records[begin[p]] to records[begin[p + 1] - 1]
  std::vector<std::int32_t> records;     ///< indices into the object's array of corrections, ascending
  std::vector<std::int64_t> pool_begin;  ///< index of each pool's first correction, and the total

  int count(int particle) const { return begin[particle + 1] - begin[particle]; }
};

/// Makes the incidence of an object. Throws an Error if it has more corrections than an index can hold.
Incidence make_incidence(const CompiledObject& object);

/// The factors of multiplier changes when corrections are averaged, one float per lane: (sum_i w_i / n_i) / (sum_i
/// w_i), with n_i the number of constraints at particle i. An averaged correction has the effect of this share of
/// dlambda; the relation is exact for distances, whose gradients have length one.
std::vector<AlignedVector<float>> averaging_shares(const CompiledObject& object, const Incidence& incidence);

}  // namespace pliant
