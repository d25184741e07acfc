// The storage of constraints that the sweeps read.
//
// A pool holds all constraints of one type and law of one object. Sixteen constraints form a batch. A batch stores its
// data contiguously, as rows of sixteen floats, in visiting order, so that a sweep reads memory once and sequentially.
// A segment is a range of batches that share no particle.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/state.h"

namespace pliant {

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// How a pool's constraints respond: by compliance, by compliance with damping, or by PBD stiffness.
enum class Law : std::int32_t { compliant, damped, pbd };

inline constexpr int batch_width = 16;
inline constexpr int most_slots = 8, most_components = 6, most_rest_fields = 32;  ///< limits of a constraint type

/// Batches of one pool that share no particle and are projected together.
struct Segment {
  std::int32_t pool = 0;
  std::int32_t runs = 0;         ///< bit s: slot s is contiguous, with four base indices per batch, not sixteen indices
  std::int32_t first_batch = 0;  ///< index of its first batch in the pool
  std::int32_t batches = 0;
  std::int32_t last_count =
      0;  ///< in the last batch: valid lanes (1..16), or groups of four (1..4) if a slot is contiguous; the rest is padding
  std::int64_t index_offset = 0;  ///< into Pool::indices
};

struct Pool {
  std::int32_t type = 0;  ///< number in constraints/registry.h
  Law law = Law::compliant;
  std::int32_t stencil = 0;              ///< slots per constraint
  std::int32_t components = 1;           ///< of C
  std::int32_t fields = 0;               ///< rows of rest data, which precede the row of the response
  bool in_lanes = true;                  ///< false: projected one at a time, in phases of Driver::stencil
  std::int32_t block_floats = 0;         ///< floats per batch in `blocks`
  std::vector<std::int32_t> row_offset;  ///< offset of each row in a batch's block; -1: equal for all, in `constants`
  std::int32_t batches = 0;
  std::int64_t constraints = 0;
  std::vector<std::int32_t> indices;
  AlignedVector<float> blocks;       ///< per batch, rows of sixteen: rest fields, then alpha or k', then beta if damped
  AlignedVector<float> constants;    ///< the rows that are equal for all constraints
  std::vector<std::int32_t> origin;  ///< per lane: index among the object's constraints of this type, -1 for padding

  /// The sixteen floats of a row for a batch, and the distance to those of the next batch. A row that is equal for all
  /// constraints (zero compliance, flat hinges) is stored once, which saves memory traffic.
  const float* row(int number, std::int64_t batch) const {
    return row_offset[number] < 0 ? constants.data() + static_cast<std::ptrdiff_t>(number) * batch_width
                                  : blocks.data() + batch * block_floats + row_offset[number];
  }
  std::int32_t row_step(int number) const { return row_offset[number] < 0 ? 0 : block_floats; }
};

/// The index of a multiplier in its pool's array: batch by batch, sixteen for each component of C.
inline std::int64_t multiplier_index(const Pool& pool, std::int64_t batch, int lane, int component) {
  return (batch * pool.components + component) * batch_width + lane;
}

/// The number of indices of a batch before those of `slot`, if the slots in `runs` are contiguous.
inline constexpr std::int32_t indices_before(std::int32_t runs, int slot) {
  std::int32_t count = 0;
  for (int before = 0; before < slot; ++before) count += (runs >> before & 1) != 0 ? 4 : batch_width;
  return count;
}

/// The number of indices of one batch of a segment.
inline std::int32_t indices_per_batch(const Pool& pool, const Segment& segment) {
  return indices_before(segment.runs, pool.stencil);
}

/// The particle in `slot` of `lane` of a batch whose indices start at `index`.
inline std::int32_t particle_of(const Segment& segment, const std::int32_t* index, int slot, int lane) {
  const std::int32_t* at = index + indices_before(segment.runs, slot);
  return (segment.runs >> slot & 1) != 0 ? at[lane % 4] + lane / 4 : at[lane];
}

/// True if the lane of the segment's batch `batch` (from 0) holds a constraint, not padding.
inline bool lane_is_valid(const Segment& segment, int batch, int lane) {
  return batch + 1 < segment.batches || (segment.runs != 0 ? lane % 4 : lane) < segment.last_count;
}

}  // namespace pliant
