// Particle-constraint incidence: the corrections that a Jacobi sweep gathers for each particle.
//
// All constraints write their corrections to separate places; each particle then sums its own in ascending order. This
// needs no atomics and gives the same bits on any number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "model/compiled_object.h"

namespace pliant {

struct Incidence {
  std::vector<std::int32_t> begin;       ///< particle p has records[begin[p]] to records[begin[p + 1] - 1]
  std::vector<std::int32_t> records;     ///< indices into the object's corrections, ascending
  std::vector<std::int64_t> pool_begin;  ///< start of each pool's corrections; one more at the end

  int count(int particle) const { return begin[particle + 1] - begin[particle]; }
};

/// Throws an Error if the object has more corrections than an index can hold.
Incidence make_incidence(const CompiledObject& object);

/// For averaging, one float per lane: (sum_i w_i / n_i) / (sum_i w_i), with n_i
/// constraints at particle i. Averaged corrections have the effect of this share of the
/// multiplier's change (exactly so for distances, whose gradients have length one).
std::vector<AlignedVector<float>> averaging_shares(const CompiledObject& object, const Incidence& incidence);

}  // namespace pliant
