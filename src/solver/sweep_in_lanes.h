// The sweep over the constraints of one type in lanes. src/solver/CMakeLists.txt makes a unit of each type of
// constraints/in_lanes.h that includes this header first and says PLIANT_SWEEP_IN_LANES(Type); it is compiled once for
// each instruction set level (cmake/PliantLanes.cmake). lanes.cpp puts them together.
//
// The sixteen constraints of a batch are projected a native vector at a time. They share no particle, so this is one
// order of many. The units use only always-inlined functions and the inline namespace of their level, so that the
// linker never mixes code of two levels.
#pragma once

#define PLIANT_ONE_REGISTER
#include <algorithm>

#include "constraints/traits.h"
#include "math/wide.h"
#include "solver/kernels.h"
#include "solver/project.h"
#include "solver/sweep_of_type.h"
#include "topology/fours.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

inline constexpr int registers_per_batch = batch_width / wide_width;

/// A value of the template parameter `fixed`: which slots are contiguous is known only at run time, for each segment.
inline constexpr std::int32_t any_set = -1;

/// Which lanes of a batch are stored: all but in the last batch of a segment.
struct ValidLanes {
  /// The first groups of four lanes if all slots of the segment are contiguous, the first lanes if none is.
  std::int32_t count;
  bool whole;  ///< all sixteen; always if some slots are contiguous and others are not (topology/colouring.cpp)
};

/// The particles of one slot for the lanes of one register. A batch of sixteen stores the indices of a slot in lane
/// order; a contiguous slot stores four, of which number j is the first of lanes j, 4 + j, 8 + j and 12 + j.
template <int size, std::int32_t fixed>
struct SlotIndices {
  std::int32_t runs;
  const std::int32_t* index;  ///< those of the batch
  std::int32_t lane = 0;      ///< the first of the register; always 0 where a register holds a batch

  PLIANT_HD std::int32_t set() const { return fixed == any_set ? runs : fixed; }
  PLIANT_HD bool in_runs(int slot) const { return (set() >> slot & 1) != 0; }
  PLIANT_HD const std::int32_t* of(int slot) const { return index + indices_before(set(), slot); }

  PLIANT_HD Registers load(const Record* base, int slot) const {
    return in_runs(slot) ? load_runs(base + lane / 4, of(slot)) : load_indexed(base, of(slot) + lane);
  }
  PLIANT_HD void store(Record* base, int slot, const Registers& records, const ValidLanes& valid) const {
    if (in_runs(slot)) return store_runs(base + lane / 4, of(slot), records, valid.whole ? 4 : valid.count);
    if (valid.whole) return store_indexed(base, of(slot) + lane, records);
    store_indexed_some(base, of(slot) + lane, records, std::min(valid.count - lane, wide_width));
  }
};

/// Positions relative to the stencil's first particle: x_i = ((position_i - position_0) + displacement_i) -
/// displacement_0, so x_0 is zero. Differences between neighbours are small and nearly exact, and constraints are
/// translation-invariant. The subtraction precedes the transpose, so that for the first particle only w is transposed.
template <int size, std::int32_t fixed>
PLIANT_HD void load_stencil(const SweepArguments& a, const SlotIndices<size, fixed>& slots, Registers (&moved)[size],
                            Vec3<Wide> (&x)[size], Wide (&w)[size]) {
  const Registers origin = slots.load(a.positions, 0);
  moved[0] = slots.load(a.displacements, 0);
  x[0] = {Wide(0.f), Wide(0.f), Wide(0.f)};
  w[0] = w_of(origin);
  PLIANT_UNROLL
  for (int slot = 1; slot < size; ++slot) {
    const Registers apart = minus_xyz(slots.load(a.positions, slot), origin);
    moved[slot] = slots.load(a.displacements, slot);
    const WideRecords records = from_registers((apart + moved[slot]) - moved[0]);
    x[slot] = records.position;
    w[slot] = records.w;
  }
}

/// Pointers to a pool's rows for one batch. A row that is constant over the pool keeps its address.
template <int rows>
struct RowPointers {
  const float* at[rows];
  std::int32_t step[rows];

  /// A row that the pool does not have is the last one again.
  PLIANT_HD RowPointers(const Pool& pool, int batch) {
    const int last = static_cast<int>(pool.row_offset.size()) - 1;
    PLIANT_UNROLL
    for (int row = 0; row < rows; ++row) {
      at[row] = pool.row(std::min(row, last), batch);
      step[row] = pool.row_step(std::min(row, last));
    }
  }
  PLIANT_HD void next() {
    PLIANT_UNROLL
    for (int row = 0; row < rows; ++row) at[row] += step[row];
  }
};

/// The displacements of a slot's particles in a substep at the velocities of its start, as coast_of.
template <int size, std::int32_t fixed>
PLIANT_HD Vec3<Wide> load_coast(const SweepArguments& a, const SlotIndices<size, fixed>& slots, int slot,
                                const Wide& w) {
  const Vec3<Wide> v = from_registers(slots.load(a.velocities, slot)).position;
  const auto falls = w > Wide(0.f);
  const Wide zero(0.f), h(a.h);
  return {(v.x + select(falls, Wide(a.gravity.x), zero)) * h, (v.y + select(falls, Wide(a.gravity.y), zero)) * h,
          (v.z + select(falls, Wide(a.gravity.z), zero)) * h};
}

/// Projects the constraints of one register: `rows` are the batch's parameters, `multiplier` its multipliers.
/// `is_damped`: the pool has dampings.
template <class T, Law law, bool keeps_multipliers, bool keeps_energy, std::int32_t fixed, int row_count>
PLIANT_HD void project_register(bool is_damped, const RowPointers<row_count>& rows,
                                const SlotIndices<slot_count<T>, fixed>& slots, float* multiplier,
                                const ValidLanes& valid, const SweepArguments& a) {
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  Vec3<Wide> x[slot_count<T>];
  Wide w[slot_count<T>];
  Registers moved[slot_count<T>];  // displacements, kept in registers, because loading the records again costs more
  load_stencil(a, slots, moved, x, w);
  Wide rest[fields];
  PLIANT_UNROLL
  for (int field = 0; field < fields; ++field) rest[field] = load_wide(rows.at[field] + slots.lane);
  typename T::template Params<Wide> params;
  std::memcpy(&params, rest, sizeof params);
  ConstraintResponse<Wide> response{load_wide(rows.at[fields] + slots.lane), Wide(0.f), Wide(0.f)};
  if constexpr (keeps_multipliers) {
    response.is_kept = multiplier != nullptr;
    if (response.is_kept && !a.first_pass) response.multiplier = load_wide(multiplier + slots.lane);
  }
  Vec3<Wide> motion[slot_count<T>];
  if constexpr (law == Law::damped) {
    response.is_damped = !keeps_energy || is_damped;
    response.damping = keeps_energy && !is_damped ? Wide(0.f) : load_wide(rows.at[fields + 1] + slots.lane);
    PLIANT_UNROLL
    for (int slot = 0; slot < slot_count<T>; ++slot)
      motion[slot] = from_registers(moved[slot] - slots.load(a.remainders, slot)).position;
  }
  Vec3<Wide> coast[slot_count<T>];
  if constexpr (keeps_energy) {
    PLIANT_UNROLL
    for (int slot = 0; slot < slot_count<T>; ++slot) coast[slot] = load_coast(a, slots, slot, w[slot]);
  }
  Vec3<Wide> correction[slot_count<T>];
  project<T, law, keeps_multipliers>(x, w, params, motion, response, a, correction, keeps_energy ? coast : nullptr);
  if constexpr (keeps_multipliers) {
    if (response.is_kept) store_wide(multiplier + slots.lane, response.multiplier);
  }
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot)
    slots.store(a.displacements, slot, moved[slot] + to_registers({correction[slot], Wide(0.f)}), valid);
}

template <class T, Law law, bool keeps_multipliers, bool keeps_energy, std::int32_t fixed>
void sweep_segment(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& arguments) {
  const SweepArguments a = arguments;  // a local copy, which no store can alias, so that it stays in registers
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  RowPointers<fields + 1 + (law == Law::damped ? 1 : 0)> rows(pool, segment.first_batch);
  SlotIndices<slot_count<T>, fixed> slots{segment.runs, pool.indices.data() + segment.index_offset};
  const bool is_damped = pool.law == Law::damped;
  float* multiplier =
      multipliers != nullptr ? multipliers + static_cast<std::int64_t>(segment.first_batch) * batch_width : nullptr;
  // One call for both: a second copy of the projection for the last batch doubles the code for nothing.
  const bool ends_whole = segment.last_count == (segment.runs != 0 ? 4 : batch_width);
  for (int left = segment.batches; left > 0; --left) {
    const ValidLanes valid{segment.last_count, left > 1 || ends_whole};
    if constexpr (registers_per_batch == 1) {
      project_register<T, law, keeps_multipliers, keeps_energy>(is_damped, rows, slots, multiplier, valid, a);
    } else {
      PLIANT_KEEP_LOOP
      for (slots.lane = 0; slots.lane < batch_width; slots.lane += wide_width)
        project_register<T, law, keeps_multipliers, keeps_energy>(is_damped, rows, slots, multiplier, valid, a);
    }
    slots.index = slots.of(slot_count<T>);
    rows.next();
    if (keeps_multipliers && multiplier != nullptr) multiplier += batch_width;
  }
}

/// Which slots are contiguous is a template argument where loads and stores take much of the time.
template <class T, Law law, bool keeps_multipliers, bool keeps_energy = false>
void sweep_either(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const auto with = [&]<std::int32_t fixed>(std::integral_constant<std::int32_t, fixed>) {
    sweep_segment<T, law, keeps_multipliers, keeps_energy, fixed>(pool, segment, multipliers, a);
  };
  constexpr std::int32_t all = (1 << slot_count<T>)-1;
  if constexpr (largest_grouped_stencil < slot_count<T>) {
    with(std::integral_constant<std::int32_t, 0>{});
  } else if constexpr (is_arithmetic<T>) {
    with(std::integral_constant<std::int32_t, any_set>{});
  } else if (segment.runs == all) {
    with(std::integral_constant<std::int32_t, all>{});
  } else if (segment.runs == 0) {
    with(std::integral_constant<std::int32_t, 0>{});
  } else if constexpr (slot_count<T> == 2) {
    segment.runs == 1 ? with(std::integral_constant<std::int32_t, 1>{})
                      : with(std::integral_constant<std::int32_t, 2>{});
  } else {
    with(std::integral_constant<std::int32_t, any_set>{});
  }
}

/// Whether multipliers are kept is a template argument where the projection is short, elsewhere a branch.
template <class T, Law law>
void sweep_law(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  constexpr bool is_short = slot_count<T> == 2;
  if constexpr (is_short) {
    if (multipliers == nullptr) return sweep_either<T, law, false>(pool, segment, multipliers, a);
  }
  sweep_either<T, law, true>(pool, segment, multipliers, a);
}

template <class T>
void sweep_type(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  if (a.keeps_energy && pool.law != Law::pbd)  // for both laws, to have less code
    return sweep_either<T, Law::damped, true, true>(pool, segment, multipliers, a);
  switch (pool.law) {
    case Law::compliant:
      return sweep_law<T, Law::compliant>(pool, segment, multipliers, a);
    case Law::damped:
      return sweep_law<T, Law::damped>(pool, segment, multipliers, a);
    case Law::pbd:
      return sweep_either<T, Law::pbd, false>(pool, segment, nullptr, a);
  }
}

}  // namespace
}  // namespace PLIANT_ISA
}  // namespace pliant

/// Defines the sweep over constraints of a type for the level that is being compiled.
#define PLIANT_SWEEP_IN_LANES(Type)                                                                                  \
  namespace pliant {                                                                                                 \
  inline namespace PLIANT_LEVEL_ISA {                                                                                \
  template <>                                                                                                        \
  void SweepOf<Type>::sweep(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) { \
    sweep_type<Type>(pool, segment, multipliers, a);                                                                 \
  }                                                                                                                  \
  }                                                                                                                  \
  }
