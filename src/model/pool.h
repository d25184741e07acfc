// Pools: the storage of constraints that the sweeps read.
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

/// A range of batches of one pool that share no particle and are projected together. Ties of one body share that and
/// nothing else.
struct Segment {
  std::int32_t pool = 0;
  std::int32_t runs = 0;  ///< bit s: slot s is contiguous, so a batch stores four indices for it instead of sixteen
  std::int32_t first_batch = 0;  ///< index of its first batch in the pool
  std::int32_t batches = 0;
  /// In the last batch: valid lanes (1..16), or groups of four (1..4) if a slot is contiguous; the rest is padding.
  std::int32_t last_count = 0;
  std::int64_t index_offset = 0;  ///< index of its first entry in Pool::indices
  bool is_of_one_body = false;    ///< ties of one body (solver/bodies/tied_body.h)
};

struct Pool {
  std::int32_t type = 0;  ///< type number (constraints/registry.h)
  Law law = Law::compliant;
  std::int32_t stencil = 0;              ///< slots per constraint
  std::int32_t components = 1;           ///< components of C, the type's rows
  std::int32_t fields = 0;               ///< number of rest data rows; the response's row follows them
  bool is_length = false;                ///< of a type with is_length (registry.h)
  bool in_lanes = true;                  ///< false: projected one at a time by Driver::stencil
  std::int32_t block_floats = 0;         ///< floats of a batch in `blocks`
  std::vector<std::int32_t> row_offset;  ///< offset of each row in a batch's block; -1: equal for all, in `constants`
  std::int32_t batches = 0;
  std::int64_t constraints = 0;
  std::vector<std::int32_t> indices;
  AlignedVector<float> blocks;     ///< rows of sixteen for each batch: rest data, then alpha or k', then beta if damped
  AlignedVector<float> constants;  ///< rows that are the same for all constraints
  std::vector<std::int32_t> origin;  ///< for each lane: index among the object's constraints of this type; -1: padding

  /// The sixteen floats of a row for a batch, and the distance to those of the next batch. A row that is equal for all
  /// constraints (zero compliance, flat hinges) is stored once, which saves memory traffic.
  const float* row(int number, std::int64_t batch) const {
    return row_offset[number] < 0 ? constants.data() + static_cast<std::ptrdiff_t>(number) * batch_width
                                  : blocks.data() + batch * block_floats + row_offset[number];
  }
  /// The same of a row that is not equal for all, to change it.
  float* change(int number, std::int64_t batch) { return blocks.data() + batch * block_floats + row_offset[number]; }
  std::int32_t row_step(int number) const { return row_offset[number] < 0 ? 0 : block_floats; }
};

/// The index of a multiplier in its pool's array, which has sixteen entries for each component of C, batch by batch.
inline std::int64_t multiplier_index(const Pool& pool, std::int64_t batch, int lane, int component) {
  return (batch * pool.components + component) * batch_width + lane;
}

/// The number of indices that a batch stores before those of `slot`, if the slots in the bit set `runs` are contiguous.
inline constexpr std::int32_t indices_before(std::int32_t runs, int slot) {
  std::int32_t count = 0;
  for (int before = 0; before < slot; ++before) count += (runs >> before & 1) != 0 ? 4 : batch_width;
  return count;
}

/// The number of indices that a batch of a segment stores.
inline std::int32_t indices_per_batch(const Pool& pool, const Segment& segment) {
  return indices_before(segment.runs, pool.stencil);
}

/// The particle in `slot` of the constraint in `lane`, for a batch whose indices start at `index`.
inline std::int32_t particle_of(const Segment& segment, const std::int32_t* index, int slot, int lane) {
  const std::int32_t* at = index + indices_before(segment.runs, slot);
  return (segment.runs >> slot & 1) != 0 ? at[lane % 4] + lane / 4 : at[lane];
}

/// True if a lane of the segment's batch number `batch` (from 0) has a constraint; false if it is padding.
inline bool lane_is_valid(const Segment& segment, int batch, int lane) {
  return batch + 1 < segment.batches || (segment.runs != 0 ? lane % 4 : lane) < segment.last_count;
}

}  // namespace pliant
