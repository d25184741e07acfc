// Which corrections reach which particle: what a Jacobi sweep gathers.
//
// The corrections of all constraints are written side by side, no two to one place, and each particle then adds up its own
// in ascending order: no atomics, and the same bits whatever thread did what.
#pragma once

#include <cstdint>
#include <vector>

#include "model/compiled_object.h"

namespace pliant {

struct Incidence {
  std::vector<std::int32_t> begin;       ///< particle p has records[begin[p]] .. records[begin[p + 1]]
  std::vector<std::int32_t> records;     ///< numbers in the object's corrections, ascending
  std::vector<std::int64_t> pool_begin;  ///< where each pool's corrections begin; one more at the end

  int count(int particle) const { return begin[particle + 1] - begin[particle]; }
};

/// Throws Error where the object has more corrections than an index holds.
Incidence make_incidence(const CompiledObject& object);

/// For averaging, one float a lane: sum_i w_i / n_i over sum_i w_i, n_i the constraints of particle i. That part of a
/// change of the multiplier is what the averaged corrections amount to (exactly for distances, whose gradients have length
/// one).
std::vector<AlignedVector<float>> averaging_shares(const CompiledObject& object, const Incidence& incidence);

}  // namespace pliant
